-- Walks in a limit cycle, as Flame did (Hobbelen, de Boer and Wisse 2008). Nothing plans the steps. One leg stands: it bears
-- the robot by torque and holds the trunk upright by its hip. The other one swings: it is led in position, to a foothold
-- that follows in each tick from where the hips are over the foot that stands and how fast they move (SIMBICON, Yin et al.
-- 2007). In the tick in which it touches the ground the legs change their parts, by a reflex. To stop, `dcm_walk` takes over.
local k = require "kadans"
local floor = require "floor"
local walk = require "walking"

local P = k.params {
  forward_m_s = { 0.3, min = 0, max = 0.45, unit = "m/s", doc = "velocity forward" },
  for_s       = { 1e5, min = 0, max = 1e5, unit = "s", doc = "how long it walks" },
  sure_s      = { 0.196, min = 0.02, max = 1, unit = "s", doc = "from when on a contact is the landing" },
  bend_s      = { 0.161, min = 0.02, max = 1, unit = "s", doc = "until when the swinging knee bends; then it stretches" },
  bend_rad    = { 0.474, min = 0, max = 1.5, unit = "rad", doc = "how far it bends" },
  land_rad    = { 0.286, min = 0, max = 1, unit = "rad", doc = "the knee that lands" },
  bear_rad    = { 0.286, min = 0, max = 1, unit = "rad", doc = "the knee that bears" },
  flat_s      = { 0.0525, min = 0, max = 1, unit = "s", doc = "until when the foot behind stays flat" },
  toe_rad     = { -0.0897, min = -0.5, max = 0.5, unit = "rad", doc = "pitch of the sole that swings" },
  ahead_m     = { 0.0272, min = -0.3, max = 0.3, unit = "m", doc = "foothold ahead of the hips" },
  ahead_s     = { 0.0716, min = 0, max = 1, unit = "s", doc = "and per velocity of the hips" },
  ahead_share = { 0.353, min = -2, max = 2, doc = "and per distance of the hips from the foot that stands" },
  slower_s    = { 0.0662, min = -1, max = 1, unit = "s", doc = "and less, per velocity that is wanted" },
  aside_m     = { 0.0787, min = -0.3, max = 0.3, unit = "m", doc = "foothold beside the middle of the hips" },
  aside_s     = { 0.0892, min = 0, max = 1, unit = "s", doc = "and per velocity" },
  aside_share = { -0.298, min = -2, max = 2, doc = "and per distance" },
}

local bone_m, half_m = 0.275, 0.085  -- thigh and shank; from the middle of the hips to each
local hips = { velocity_max_rad_s = 3.29, acceleration_max_rad_s2 = 150 }
local knees = { velocity_max_rad_s = 7, acceleration_max_rad_s2 = 250 }
local fade_s, trim = 0.029, 0.2  -- in which the torques from before a landing go; share of an error that two steps correct
local joints = { "hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch" }
local left = { side = 1, stands = "left_stands", swings = "left_swings", holding = "l_holds", moving = "l_swings" }
local right = { side = -1, stands = "right_stands", swings = "right_swings", holding = "r_holds", moving = "r_swings" }
for _, joint in ipairs(joints) do left[joint], right[joint] = "l_" .. joint, "r_" .. joint end

local function lies(s) return floor.lies(s.base) end

-- From the ankle of this leg to the middle of the hips, near which the centre of mass is: ahead, and inward; and how fast.
local function over(s, a)
  local rate, pitch, knee, roll = s.base.angular_velocity_rad_s, s.joints[a.hip_pitch], s.joints[a.knee], s.joints[a.hip_roll]
  local thigh_rad, thigh_rad_s = s.base.pitch_rad + pitch.position_rad, rate.y + pitch.velocity_rad_s
  local shank_rad, shank_rad_s = thigh_rad + knee.position_rad, thigh_rad_s + knee.velocity_rad_s
  local high_m = bone_m * (math.cos(thigh_rad) + math.cos(shank_rad))
  return {
    x_m = bone_m * (math.sin(thigh_rad) + math.sin(shank_rad)),
    x_m_s = bone_m * (math.cos(thigh_rad) * thigh_rad_s + math.cos(shank_rad) * shank_rad_s),
    in_m = half_m + a.side * high_m * math.sin(s.base.roll_rad + roll.position_rad),
    in_m_s = a.side * high_m * (rate.x + roll.velocity_rad_s),
  }
end

-- In each tick: leads the leg to where its foot shall land.
local function swing(m, s, stand, a)
  local at, v = over(s, stand), m.vars
  local x_m = P.ahead_m + P.ahead_s * at.x_m_s + P.ahead_share * at.x_m - P.slower_s * v.forward_m_s
  local out_m = P.aside_m + P.aside_s * at.in_m_s + P.aside_share * (at.in_m - half_m) - a.side * P.slower_s * v.left_m_s
  local knee_rad = m.time_s < P.bend_s and P.bend_rad or P.land_rad
  local sole_rad = m.time_s < P.flat_s and 0 or P.toe_rad
  local long_m = 2 * bone_m * math.cos(knee_rad / 2)
  local thigh_rad = -math.asin(walk.within(x_m / long_m, 0.6)) - knee_rad / 2
  local roll_rad = a.side * math.asin(walk.within((out_m - half_m) / long_m, 0.4))
  m[a.moving]:follow({
    [a.hip_pitch] = walk.within(thigh_rad - s.base.pitch_rad, 0.59),
    [a.hip_roll] = walk.within(roll_rad - s.base.roll_rad, 0.45),
    [a.hip_yaw] = walk.within(walk.angle(v.heading_rad - s.odometry.heading_rad), 0.3),
  }, hips)
  m[a.moving]:follow({ [a.knee] = knee_rad, [a.ankle_pitch] = walk.within(sole_rad - thigh_rad - knee_rad, 0.75) }, knees)
end

-- The torques that the joints had before go, while the leg that stands takes the load.
local function change(c, stand, a)
  for _, joint in ipairs(joints) do
    c[stand.holding]:set(stand[joint] .. ".effort_Nm", 0, { time_s = fade_s })
    c[a.moving]:set(a[joint] .. ".effort_Nm", 0, { time_s = fade_s })
  end
  c[stand.holding]:move({ [stand.knee] = P.bear_rad, [stand.hip_yaw] = 0 }, { time_s = 0.1 })
end

-- Each second step: the velocity that the next ones are aimed at makes good for what two steps lacked, by the odometry.
local function aim(m, s)
  local v, o = m.vars, s.odometry
  if v.at then
    local time_s, ahead_m, left_m = s.time_s - v.at.time_s, walk.as_seen(v.at, o)
    v.forward_m_s = walk.within(v.forward_m_s + trim * (P.forward_m_s - ahead_m / time_s), 1.5)
    v.left_m_s = walk.within(v.left_m_s - trim * left_m / time_s, 0.6)
  end
  v.at = { x_m = o.x_m, y_m = o.y_m, heading_rad = o.heading_rad, time_s = s.time_s }
end

local function step(name, stand, a, landed, next_name)
  return k.state(name) {
    controls = { stand.stands, a.swings, "arms" },
    enter = function(m, s)
      if not m.vars.at then change(m, stand, a) end  -- the first step
      if stand == left then aim(m, s) end
    end,
    during = function(m, s) swing(m, s, stand, a) end,
    run = function(m)
      m:wait(P.sure_s)
      m:on(landed, function(c)
        c:use(a.stands)
        c:use(stand.swings)
        change(c, a, stand)
      end, { within_s = 2, event = "landed" })
    end,
    { on = "landed", when = function(s, m) return s.time_s - m.vars.since_s > P.for_s end, to = "stop" },
    { on = "landed", to = next_name },
    { when = lies, to = "fallen", why = "lies" },
  }
end

return k.behavior "walk_cycle" {
  vars    = { forward_m_s = 0, left_m_s = 0, heading_rad = 0, since_s = 0 },
  initial = "set_out",
  k.state "set_out" {
    controls = "posture",
    run = function(m, s)
      m.posture:set_gains("stiff")
      m.posture:move("stand", { time_s = 0.8 }):wait()
      m.vars.at, m.vars.forward_m_s, m.vars.left_m_s = nil, P.forward_m_s, 0
      m.vars.heading_rad, m.vars.since_s = s.odometry.heading_rad, s.time_s
    end,
    { on = "run.done", to = "left" },
    { when = lies, to = "fallen", why = "lies" },
  },
  step("left", left, right, "foot.right.contact", "right"),
  step("right", right, left, "foot.left.contact", "left"),
  k.state "stop" {
    controls = "walking",
    run = function(m)
      m.walk:set_gains("usual")
      m.posture:move("set_out", { time_s = 0.5 })
      walk.go(m, { forward_m_s = P.forward_m_s })
      m:wait(1)
      walk.stop(m)
      while not walk.stands(m) do m:wait(0.05) end
    end,
    { on = "run.done", to = "stands" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.final "stands" { outcome = "done" },
  k.state "fallen" {
    k.call "get_up",
    { on = "done", to = "set_out" },
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

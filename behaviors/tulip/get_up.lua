-- Gets up from any position: waits until the robot lies still, finds out how it lies, rolls onto the face if needed,
-- folds onto hands and feet, and rises. When something goes wrong, it lies down again and begins anew, a few times.
--
-- When the first try succeeds, it passes through "at_once" on its way to "up": sweeps count that state, number 1.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  tries       = { 5, min = 1, max = 10, doc = "how often it tries" },
  rolls       = { 4, min = 1, max = 10, doc = "how often it rolls in one try" },
  still_s     = { 0.35, min = 0, max = 5, unit = "s", doc = "time to lie still before it begins: torque is back by then" },
  still_rad_s = { 0.5, min = 0.05, max = 5, unit = "rad/s", doc = "turning rate below which it lies still" },
  patience_s  = { 2.0, min = 0.1, max = 20, unit = "s", doc = "longest wait to lie still" },
  bear_s      = { 0.05, min = 0, max = 2, unit = "s", doc = "time to come to rest on hands and feet" },
  bear_min_s      = { 0, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  bear_max_s      = { 3, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  ahead_s      = { 0.2, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  foot_rad      = { 0.15, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  near_m      = { 0.06, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  rear_m      = { 0.07, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  flat      = { 1, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  b_hip      = { -2.38, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  b_knee      = { 0.15, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  b_ankle      = { 0.15, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  b_sh      = { -0.4, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  flat_move_s      = { 0.25, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  bear2_s      = { 0.5, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  wide      = { 0.06, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  sf      = { 0, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  least_s      = { 0.75, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  from      = { 0, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  over      = { 3, min = 0, max = 14, unit = "s", doc = "time to come to rest on hands and feet" },
  face_s      = { 0.8, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  frees      = { 2, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  prone_s      = { 0.2, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  calm_s      = { 0.1, min = 0, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  sx0      = { 0, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  sx      = { 1, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  sy      = { 1, min = -4, max = 4, unit = "s", doc = "time to come to rest on hands and feet" },
  steady_s    = { 2.0, min = 0.1, max = 10, unit = "s", doc = "time to stand before it counts" },
  tilt_rad    = { 0.2, min = 0.05, max = 1, unit = "rad", doc = "most that it may lean then" },
  height_m    = { 0.75, min = 0.3, max = 1, unit = "m", doc = "least height of the torso then" },
  lean_rad    = { 0.0, min = -0.2, max = 0.2, unit = "rad", doc = "how far back it leans in the ankles while it rises" },
  learn_rad   = { 0.03, min = 0, max = 0.2, unit = "rad", doc = "change of that after a fall, away from where it fell" },
  folded      = { -1, min = -1, max = 1, doc = "up, along its height, below which it is still folded when it falls" },
  straight_s  = { 0.28, min = 0.02, max = 2, unit = "s", doc = "time to stretch the legs after a roll" },
  turn_s      = { 0.3, min = 0, max = 2, unit = "s", doc = "time to come round onto its face after a roll" },
  face        = { -0.85, min = -1, max = -0.3, doc = "up, along its front, when it lies on its face" },
  flat_s      = { 0.3, min = 0, max = 2, unit = "s", doc = "from then on in the rise the ankles keep the balance" },
  roll_way    = { 1, min = 1, max = 2, doc = "how it rolls first in a try, 2: as soft springs want it; then as 1" },
  fold_pace   = { 1, min = 0.5, max = 3, doc = "times the time that it folds onto hands and feet in" },
  rise_pace   = { 1, min = 0.5, max = 3, doc = "times the time that it rises in; soft springs want more" },
  sway_s      = { 1.5, min = 0.1, max = 10, unit = "s", doc = "time it may sway before it stands" },
}

local function rate(s)
  local w = s.base.angular_velocity_rad_s
  return math.sqrt(w.x ^ 2 + w.y ^ 2 + w.z ^ 2)
end

local function stands(s)
  return s.base.tilt_rad < P.tilt_rad and s.base.height_m > P.height_m and s.feet.left.contact and s.feet.right.contact
end

-- Folded on its hands and feet, head down.
local function bears(s)
  local up = floor.up(s.base)
  return s.feet.left.contact and s.feet.right.contact and up.x < -0.4 and math.abs(up.y) < 0.4
end

-- Rather than backward. Who falls backward while still folded has its face down, too, but its head below its hips.
local function fell_forward(s)
  local up = floor.up(s.base)
  return up.x < 0 and up.z > P.folded
end

local function is(posture) return function(s) return s.base.posture == posture end end

local function play(m, steps)
  for _, step in ipairs(steps) do m.posture:move(step[1], { time_s = step.time_s }):wait() end
end

local function roll(over)
  return {
    run = function(m, s)
      m:clear_faults()
      m.vars.rolls = m.vars.rolls + 1
      m.vars.turned = false
      play(m, floor.roll(over, s.joints, m.vars.rolls % 2 == 1 and P.roll_way or 3 - P.roll_way))
      m.posture:move(floor.lying(), { time_s = P.straight_s }):wait()
      m.vars.turned = true
      m:wait(P.turn_s)
    end,
    { when = function(s, m) return m.vars.turned and floor.up(s.base).x < P.face end, to = "face" },
    { on = "run.done", when = function(_, m) return m.vars.rolls < P.rolls end, to = "look", why = "did not roll over" },
    { on = "run.done", to = "again", why = "did not roll over" },
  }
end

local function com(s)
  local up, j = floor.up(s.base), s.joints
  local lean = math.atan2(-up.x, up.z)
  local hip = (j.l_hip_pitch.position_rad + j.r_hip_pitch.position_rad) / 2
  local knee = (j.l_knee.position_rad + j.r_knee.position_rad) / 2
  local ankle = (j.l_ankle_pitch.position_rad + j.r_ankle_pitch.position_rad) / 2
  local arm = (j.l_shoulder_pitch.position_rad + j.r_shoulder_pitch.position_rad) / 2
  return floor.com(lean, hip, knee, ankle, arm)
end

local function note(what, s)
  local up, j = floor.up(s.base), s.joints
  local lean = math.atan2(-up.x, up.z)
  local l = lean + j.l_hip_pitch.position_rad + j.l_knee.position_rad + j.l_ankle_pitch.position_rad
  local r = lean + j.r_hip_pitch.position_rad + j.r_knee.position_rad + j.r_ankle_pitch.position_rad
  local x, z = com(s)
  k.log.info(string.format("%s com %.3f %.2f up %.2f %.2f %.2f lean %.2f feet %.2f %.2f  l %.0f %.3f r %.0f %.3f hip %.2f %.2f kn %.2f %.2f an %.2f %.2f sh %.2f %.2f w %.2f roll %.2f %.2f yaw %.2f %.2f aroll %.2f %.2f", what, x, z, up.x, up.y, up.z, lean, l, r, s.feet.left.force_N, s.feet.left.cop_x_m, s.feet.right.force_N, s.feet.right.cop_x_m,
   j.l_hip_pitch.position_rad, j.r_hip_pitch.position_rad, j.l_knee.position_rad, j.r_knee.position_rad, j.l_ankle_pitch.position_rad,j.r_ankle_pitch.position_rad,j.l_shoulder_pitch.position_rad,j.r_shoulder_pitch.position_rad, s.base.angular_velocity_rad_s.y, j.l_hip_roll.position_rad, j.r_hip_roll.position_rad, j.l_hip_yaw.position_rad, j.r_hip_yaw.position_rad, j.l_ankle_roll.position_rad, j.r_ankle_roll.position_rad))
end

local function rears(s, m)
  local x, z, foot = com(s)
  local to = x + P.ahead_s * z * s.base.angular_velocity_rad_s.y
  return x < P.near_m and to < P.rear_m and to > -0.1 and floor.up(s.base).z < 0 and math.abs(foot + m.vars.slope_x) < P.foot_rad
end

return k.behavior "get_up" {
  controls = "balanced",
  vars     = { tried = 0, still_s = 0, arms = {}, learnt_rad = 0, slope_x = 0, slope_y = 0, rolls = 0, turned = false },
  initial  = "lie",

  k.state "at_once" { { after = 0, to = "up" } },
  k.final "up"      { outcome = "done" },

  k.state "lie" {
    enter = function(m, s)
      m:clear_faults()
      m.vars.still_s, m.vars.rolls = 0, 0
      m.posture:set_gains("get_up")
      m.balance:set_parameter("share", 0)
      m.stance:set_parameter("share", 0)
      m.posture:move(floor.up(s.base).x < -0.9 and floor.prone(s.joints) or floor.lying(), { time_s = 0.4 })
    end,
    during = function(m, s)
      m.vars.still_s = rate(s) < P.still_rad_s and m.vars.still_s + 0.01 or 0
    end,
    { when = function(_, m) return m.vars.still_s >= P.still_s and m.time_s > P.least_s end, to = "look" },
    { after = P.patience_s, to = "look" },
  },
  k.state "face" {
    run = function(m, s)
      m:clear_faults()
      for i = 0, P.frees do
        m.posture:move(floor.prone(s.joints), { time_s = P.prone_s })
        local waited, still = 0, 0
        while waited < P.face_s and still < P.calm_s do
          m:wait(0.02)
          waited, still = waited + 0.02, rate(s) < P.still_rad_s and floor.up(s.base).x < -0.97 and still + 0.02 or 0
        end
        if i == P.frees or not floor.caught(s.joints) then return end
        note("caught", s)
        play(m, floor.freeing(s.joints))
      end
    end,
    { on = "run.done", to = "fold" },
  },
  k.state "look" {
    enter = function(m)
      if m.vars.rolls == 0 then m.vars.tried = m.vars.tried + 1 end
    end,
    { when = stands, to = "steady" },
    { when = function(s) return floor.up(s.base).x < -0.97 and not floor.caught(s.joints) end, to = "fold" },
    { when = is "prone", to = "face" },
    { when = function(s) return s.base.posture == "left" or floor.up(s.base).y <= 0 end, to = "roll_left" },
    { after = 0, to = "roll_right" },
  },
  k.state "roll_left"  (roll "left"),
  k.state "roll_right" (roll "right"),
  k.state "fold" {
    run = function(m, s)
      m:clear_faults()
      note("lying", s)
      local up = floor.up(s.base)
      if up.x < -0.98 then
        m.vars.slope_x = math.max(-0.1, math.min(0.1, up.z))
        m.vars.slope_y = math.max(-0.1, math.min(0.1, up.y))
      end
      local steps, turns = floor.fold(s.joints, P.fold_pace, P.sf * m.vars.slope_y, P.wide)
      m.vars.arms = turns
      play(m, steps)
      m:wait(P.bear_s)
    end,
    { on = "run.done", to = "bear" },
  },
  k.state "bear" {
    run = function(m, s)
      m:clear_faults()
      note("folded", s)
      local step = floor.bear(m.vars.arms, P.lean_rad + m.vars.learnt_rad - P.sx0 * m.vars.slope_x, P.sy * m.vars.slope_y, P.wide)
      m.posture:move(step[1], { time_s = step.time_s }):wait()
      if P.flat <= 0 then return end
      while true do
        note("flat", s)
        local up, j = floor.up(s.base), s.joints
        local lean = math.atan2(-up.x, up.z)
        local l = lean + j.l_hip_pitch.position_rad + j.l_knee.position_rad
        local r = lean + j.r_hip_pitch.position_rad + j.r_knee.position_rad
        local pose = {}
        for n, v in pairs(step[1]) do pose[n] = v end
        pose.l_ankle_pitch = math.max(-0.9, math.min(0.7, -l - m.vars.slope_x))
        pose.r_ankle_pitch = math.max(-0.9, math.min(0.7, -r - m.vars.slope_x))
        pose.l_hip_pitch, pose.r_hip_pitch = P.b_hip, P.b_hip
        pose.l_knee, pose.r_knee = P.b_knee, P.b_knee
        m.posture:move(pose, { time_s = P.flat_move_s }):wait()
        note("flat2", s)
        pose.l_ankle_pitch, pose.r_ankle_pitch = P.b_ankle, P.b_ankle
        for _, n in ipairs { "l_shoulder_pitch", "r_shoulder_pitch" } do pose[n] = pose[n] + (pose[n] > 0 and 1 or 1) * P.b_sh end
        m.posture:move(pose, { time_s = P.bear2_s }):wait()
      end
    end,
    { when = function(s, m) return m.time_s >= P.bear_min_s and bears(s) and rears(s, m) end, to = "rise" },
    { when = function(s, m) return m.time_s > 0.3 and (floor.up(s.base).z > 0 or math.abs(floor.up(s.base).y) > 0.75) end, to = "again", why = "fell over" },
    { after = P.bear_max_s, when = bears, to = "rise" },
    { after = P.bear_max_s, to = "again", why = "not on hands and feet" },
  },
  k.state "rise" {
    run = function(m, s)
      m:clear_faults()
      note("rise", s)
      m.posture:set_gains("rise")
      local x, z = com(s)
      local from = P.from * (x - 0.03) / z
      local motion = m.posture:move_through(floor.rise(m.vars.arms, P.lean_rad + m.vars.learnt_rad, P.rise_pace, P.sx * m.vars.slope_x, P.sy * m.vars.slope_y, P.wide, from, P.over))
      m:wait(P.flat_s)
      m.balance:set_parameter("share", 1)
      motion:wait()
    end,
    { on = "run.done", to = "steady" },
    { when = function(s, m) return m.time_s > 1 and floor.up(s.base).z < 0.3 end, to = "fell" },
  },
  k.state "steady" {
    initial = "sways",
    enter = function(m, s) note("steady", s) end,
    { when = function(s) return s.base.tilt_rad > 0.8 end, to = "fell" },
    k.state "sways" {
      { when = stands, to = "stands" },
      { after = P.sway_s, to = "again", why = "does not stand" },
    },
    k.state "stands" {
      { when = function(s) return not stands(s) end, to = "sways" },
      { when = function(_, m) return m.vars.tried == 1 end, after = P.steady_s, to = "at_once" },
      { after = P.steady_s, to = "up" },
    },
  },
  k.state "fell" {
    enter = function(m, s)
      note("fell", s)
      m.vars.learnt_rad = m.vars.learnt_rad + (fell_forward(s) and P.learn_rad or -P.learn_rad)
    end,
    { after = 0, to = "again" },
  },
  k.state "again" {
    { when = function(_, m) return m.vars.tried >= P.tries end, to = "failed" },
    { after = 0, to = "lie" },
  },
  k.final "failed" { outcome = "failed" },
}

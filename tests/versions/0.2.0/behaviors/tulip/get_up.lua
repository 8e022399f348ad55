-- Gets up from any position: waits until the robot lies still, finds out how it lies, rolls onto the face if needed,
-- folds onto hands and feet, and rises. When something goes wrong, it lies down again and begins anew, a few times.
--
-- When the first try succeeds, it passes through "at_once" on its way to "up": sweeps count that state, number 1.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  tries       = { 3, min = 1, max = 10, doc = "how often it tries" },
  rolls       = { 2, min = 1, max = 10, doc = "how often it rolls in one try" },
  still_s     = { 0.35, min = 0, max = 5, unit = "s", doc = "time to lie still before it begins: torque is back by then" },
  still_rad_s = { 0.5, min = 0.05, max = 5, unit = "rad/s", doc = "turning rate below which it lies still" },
  patience_s  = { 2.0, min = 0.1, max = 20, unit = "s", doc = "longest wait to lie still" },
  bear_s      = { 0.05, min = 0, max = 2, unit = "s", doc = "time to come to rest on hands and feet" },
  steady_s    = { 2.0, min = 0.1, max = 10, unit = "s", doc = "time to stand before it counts" },
  tilt_rad    = { 0.2, min = 0.05, max = 1, unit = "rad", doc = "most that it may lean then" },
  height_m    = { 0.75, min = 0.3, max = 1, unit = "m", doc = "least height of the torso then" },
  lean_rad    = { 0.0, min = -0.2, max = 0.2, unit = "rad", doc = "how far back it leans in the ankles while it rises" },
  learn_rad   = { 0.03, min = 0, max = 0.2, unit = "rad", doc = "change of that after a fall, away from where it fell" },
  folded      = { -1, min = -1, max = 1, doc = "up, along its height, below which it is still folded when it falls" },
  straight_s  = { 0.22, min = 0.02, max = 2, unit = "s", doc = "time to stretch the legs after a roll" },
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
      m.vars.rolls = m.vars.rolls + 1
      m.vars.turned = false
      play(m, floor.roll(over, s.joints, m.vars.rolls == 1 and P.roll_way > 1.5 and 2 or 1))
      m.posture:move(floor.lying(), { time_s = P.straight_s }):wait()
      m.vars.turned = true
      m:wait(P.turn_s)
    end,
    { when = function(s, m) return m.vars.turned and floor.up(s.base).x < P.face end, to = "fold" },
    { on = "run.done", when = function(_, m) return m.vars.rolls < P.rolls end, to = "look", why = "did not roll over" },
    { on = "run.done", to = "again", why = "did not roll over" },
  }
end

return k.behavior "get_up" {
  controls = "balanced",
  vars     = { tried = 0, still_s = 0, arms = {}, learnt_rad = 0, rolls = 0, turned = false },
  initial  = "lie",

  k.state "at_once" { { after = 0, to = "up" } },
  k.final "up"      { outcome = "done" },

  k.state "lie" {
    enter = function(m)
      m:clear_faults()
      m.vars.still_s, m.vars.rolls = 0, 0
      m.posture:set_gains("get_up")
      m.balance:set_parameter("share", 0)
      m.stance:set_parameter("share", 0)
      m.posture:move(floor.lying(), { time_s = 0.4 })
    end,
    during = function(m, s)
      m.vars.still_s = rate(s) < P.still_rad_s and m.vars.still_s + 0.01 or 0
    end,
    { when = function(_, m) return m.vars.still_s >= P.still_s end, to = "look" },
    { after = P.patience_s, to = "look" },
  },
  k.state "look" {
    enter = function(m)
      if m.vars.rolls == 0 then m.vars.tried = m.vars.tried + 1 end
    end,
    { when = stands, to = "steady" },
    { when = is "prone", to = "fold" },
    { when = function(s) return s.base.posture == "left" or floor.up(s.base).y <= 0 end, to = "roll_left" },
    { after = 0, to = "roll_right" },
  },
  k.state "roll_left"  (roll "left"),
  k.state "roll_right" (roll "right"),
  k.state "fold" {
    run = function(m, s)
      local steps, turns = floor.fold(s.joints, P.fold_pace)
      m.vars.arms = turns
      play(m, steps)
      m:wait(P.bear_s)
      play(m, { floor.bear(turns, P.lean_rad + m.vars.learnt_rad) })
    end,
    { on = "run.done", when = bears, to = "rise" },
    { on = "run.done", to = "again", why = "not on hands and feet" },
  },
  k.state "rise" {
    run = function(m)
      m.posture:set_gains("rise")
      local motion = m.posture:move_through(floor.rise(m.vars.arms, P.lean_rad + m.vars.learnt_rad, P.rise_pace))
      m:wait(P.flat_s)
      m.balance:set_parameter("share", 1)
      motion:wait()
    end,
    { on = "run.done", to = "steady" },
    { when = function(s, m) return m.time_s > 1 and floor.up(s.base).z < 0.3 end, to = "fell" },
  },
  k.state "steady" {
    initial = "sways",
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

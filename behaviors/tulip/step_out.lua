-- Stands its ground with one foot ahead; a push that standing does not hold it catches by stepping. What the step leaves
-- the legs bear by force, apart, as in stay_up. When it falls all the same it gets up, and stands its ground on parallel
-- feet.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  spread_s = { 0.1, min = 0, max = 5, unit = "s", doc = "time from the landing in which the hips roll apart" },
  bear_s   = { 0.1, min = 0, max = 5, unit = "s", doc = "time from the landing until the legs bear by force" },
  fade_s   = { 0.25, min = 0, max = 5, unit = "s", doc = "from then on, until the step and the pose give way" },
}

local function lies(s) return floor.posture(s.base) ~= "upright" end

-- The right foot, which was behind, has come down ahead.
local function passed(s)
  local ahead = s.joints.r_hip_pitch.position_rad < s.joints.l_hip_pitch.position_rad - 0.1
  return ahead and s.feet.left.contact and s.feet.right.contact
end

return k.behavior "step_out" {
  controls = "balanced",
  initial  = "stand",

  k.state "stand" {
    enter = function(m)
      m.posture:set_gains("step")
      m.posture:move("poised", { time_s = P.settle_s })
      m.stance:set_parameter("share", 0)
      m.balance:set_parameter("share", 1)
      m.step:set_parameter("enabled", 1)
    end,
    { when = lies, to = "fallen", why = "lies" },
    { when = passed, to = "caught", why = "the foot behind is ahead" },
  },
  k.state "caught" {
    run = function(m)
      m.posture:move("ready", { time_s = P.spread_s })
      m:wait(P.bear_s)
      m.stance:set_parameter("share", 1)
      m:wait(P.fade_s)
      m.balance:set_parameter("share", 0)
      m.posture:set_gains("balance")
      m.step:set_parameter("enabled", 0)
    end,
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "fallen" {
    enter = function(m) m.step:set_parameter("enabled", 0) end,
    k.call "get_up",
    { on = "done", to = "upright" },
    { on = "failed", to = "failed" },
  },
  k.state "upright" {
    k.call "stay_up",
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

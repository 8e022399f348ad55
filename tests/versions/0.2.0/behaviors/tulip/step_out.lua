-- Keeps its balance with one foot ahead, by forces, as stay_up does. A push forward that standing does not hold is
-- caught by a step. The robot rests nearer to the foot ahead, because it stands on that foot while it steps. After the
-- step the legs carry by forces again, apart and in the middle. When the robot falls nevertheless, it gets up, and
-- keeps its balance on parallel feet.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  firm_s   = { 0.5, min = 0, max = 5, unit = "s", doc = "time until the legs bear by force, and the pose gives way" },
  aside_m  = { 0.035, min = -0.1, max = 0.1, unit = "m", doc = "how far from the middle it rests, to the foot ahead" },
  spread_s = { 0.1, min = 0, max = 5, unit = "s", doc = "time from the landing in which the hips roll apart" },
  hold_s   = { 0.27, min = 0, max = 5, unit = "s", doc = "time from the landing until the step gives way" },
}

local function lies(s) return floor.lies(s.base) end

-- The right foot, which was behind, has come down ahead.
local function passed(s)
  local ahead = s.joints.r_hip_pitch.position_rad < s.joints.l_hip_pitch.position_rad - 0.1
  return ahead and s.feet.left.contact and s.feet.right.contact
end

return k.behavior "step_out" {
  controls = "balanced",
  initial  = "stand",

  k.state "stand" {
    run = function(m)
      m.posture:set_gains("step")
      m.posture:move("poised", { time_s = P.settle_s })
      m.stance:set_parameter("offset_y_m", P.aside_m)
      m.stance:set_parameter("share", 1)
      m:wait(P.firm_s)
      m.balance:set_parameter("share", 0)
      m.posture:set_gains("balance")
      m.step:set_parameter("enabled", 1)
    end,
    { when = lies, to = "fallen", why = "lies" },
    { when = passed, to = "caught", why = "the foot behind is ahead" },
  },
  k.state "caught" {
    run = function(m)
      m.posture:move("ready", { time_s = P.spread_s })
      m.stance:set_parameter("offset_y_m", 0)
      m:wait(P.hold_s)
      m.step:set_parameter("enabled", 0)
    end,
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "fallen" {
    enter = function(m)
      m.step:set_parameter("enabled", 0)
      m.stance:set_parameter("offset_y_m", 0)
      m.stance:set_parameter("share", 0)
    end,
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

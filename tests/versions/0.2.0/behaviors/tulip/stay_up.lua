-- Keeps its balance when it is pushed. When the robot falls nevertheless, it falls softly and gets up again.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  bear_s   = { 0.25, min = 0, max = 5, unit = "s", doc = "time until the legs bear by force, and the pose gives way" },
  gather_s = { 1.2, min = 0.1, max = 10, unit = "s", doc = "time to bring the arms back after a fall" },
  arms_rad = { -0.5, min = -2, max = 2, unit = "rad", doc = "where to" },
}

local function lies(s) return floor.lies(s.base) end

return k.behavior "stay_up" {
  controls = "balanced",
  initial  = "stand",

  k.state "stand" {
    run = function(m)
      m.posture:move("ready", { time_s = P.settle_s })
      m.stance:set_parameter("share", 1)
      m:wait(P.bear_s)
      m.balance:set_parameter("share", 0)
      m.posture:set_gains("balance")
    end,
    { when = lies, to = "fallen_gathers" },
  },
  k.state "fallen_gathers" {  -- the arms may have swung round
    enter = function(m)
      m:clear_faults()
      m.stance:set_parameter("share", 0)
      m.posture:set_gains("get_up")
      m.posture:move({ l_shoulder_pitch = P.arms_rad, r_shoulder_pitch = P.arms_rad }, { time_s = P.gather_s })
    end,
    { after = P.gather_s, to = "fallen" },
  },
  k.state "fallen" {
    k.call "get_up",
    { on = "done", to = "stand" },
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

-- Stands its ground with one foot ahead; a push that standing does not hold it catches by stepping. When it falls all
-- the same it gets up, and stands its ground on parallel feet.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
}

local function lies(s) return floor.posture(s.base) ~= "upright" end

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
    exit = function(m) m.step:set_parameter("enabled", 0) end,
    { when = lies, to = "fallen" },
  },
  k.state "fallen" {
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

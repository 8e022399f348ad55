-- Stands its ground: keeps its balance when it is pushed; when it falls all the same it falls soft, and gets up again.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
}

local function lies(s) return floor.posture(s.base) ~= "upright" end

return k.behavior "stay_up" {
  controls = "balanced",
  initial  = "stand",

  k.state "stand" {
    enter = function(m)
      m.posture:set_gains("balance")
      m.posture:move("ready", { time_s = P.settle_s })
      m.balance:set_parameter("share", 1)
    end,
    { when = lies, to = "fallen" },
  },
  k.state "fallen" {
    k.call "get_up",
    { on = "done", to = "stand" },
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

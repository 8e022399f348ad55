-- Stands still and stiff until it is told otherwise.
local k = require "kadans"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
}

return k.behavior "stand" {
  controls = "posture",
  initial  = "stand",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "stand" {
    endless = true,
    enter = function(m)
      m.posture:set_gains("stiff")
      m.posture:move("stand", { time_s = P.settle_s })
    end,
  },
  k.final "failed" { outcome = "failed" },
}

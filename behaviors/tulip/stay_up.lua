-- Stands its ground: keeps its balance when it is pushed; when it falls all the same it falls soft, and gets up again.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  settle_s = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  bear_s   = { 0.25, min = 0, max = 5, unit = "s", doc = "time until the legs bear by force, and the pose gives way" },
}

local function lies(s) return floor.posture(s.base) ~= "upright" end

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
    { when = lies, to = "fallen" },
  },
  k.state "fallen" {
    k.call "get_up",
    { on = "done", to = "stand" },
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

-- Looks left, right and ahead again. The profile keeps its limits, whatever time it is given.
local k = require "kadans"
local gestures = require "gestures"

local P = k.params {
  times  = { 1, min = 1, max = 100, doc = "how often" },
  time_s = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to turn" },
  rest_s = { 0.2, min = 0, max = 10, unit = "s", doc = "time to look in each direction" },
}

return k.behavior "look" {
  controls = "position",
  vars     = { poses = 0 },
  initial  = "around",

  gestures.through "around" {
    object = "profile", poses = { "left", "right", "ahead" },
    times = P.times, time_s = P.time_s, rest_s = P.rest_s,
    { on = "done", to = "done", action = function(m, s) m.vars.poses = s.event.data.result.poses end },
  },
  k.final "done" { outcome = "done", result = function(m) return { poses = m.vars.poses } end },
}

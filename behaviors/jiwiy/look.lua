-- Looks left, right and ahead again. The profile keeps its limits, whatever time it is given.
local k = require "kadans"

local P = k.params {
  times  = { 1, min = 1, max = 100, doc = "how often" },
  time_s = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to turn" },
  rest_s = { 0.2, min = 0, max = 10, unit = "s", doc = "time to look in each direction" },
}

return k.behavior "look" {
  controls = "position",
  initial  = "around",

  k.state "around" {
    run = function(m)
      for _ = 1, P.times do
        for _, pose in ipairs { "left", "right", "ahead" } do
          m.profile:move(pose, { time_s = P.time_s }):wait()
          m:wait(P.rest_s)
        end
      end
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}

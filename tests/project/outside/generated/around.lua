-- Leads both joints around on the control set `generated`, whose law is C code that a tool made.
local k = require "kadans"

return k.behavior "around" {
  controls = "generated",
  initial  = "around",
  k.state "around" {
    run = function(m)
      m.generated:move({ pan = 0.5, tilt = 0 }, { time_s = 1.2 }):wait()
      m.generated:move_through({
        { { pan = 0, tilt = 0.4 }, time_s = 1 },
        { { pan = -0.5, tilt = 0 }, time_s = 1 },
        { { pan = 0, tilt = 0 }, time_s = 1 },
      }):wait()
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}

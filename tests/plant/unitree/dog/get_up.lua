-- Stands up from where it lies, and stands.
local k = require "kadans"

return k.behavior "get_up" {
  controls = "hold",
  initial  = "up",
  k.state "up" {
    run = function(m) m.posture:move("stand", { time_s = 1.5 }):wait() end,
    { on = "run.done", to = "stands" },
  },
  k.state "stands" { endless = true },
}

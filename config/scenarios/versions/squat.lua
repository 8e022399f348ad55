-- Another version of the squat, which does not stay down: what reload_while_down.json reloads.
local k = require "kadans"
local legs = require "legs"

local thigh_m, shank_m = 0.275, 0.275

return k.behavior "squat" {
  controls = "posture",
  vars     = { done = 0 },
  initial  = "settle",

  k.state "settle" {
    enter = function(m) m.posture:move("stand", { time_s = 1.5 }) end,
    { after = 1.5, to = "squat" },
  },
  k.state "squat" {
    run = function(m)
      m.posture:move(legs.lowered(k.pose "stand", { "l_", "r_" }, thigh_m, shank_m, 0.1), { time_s = 1.5 }):wait()
      m.posture:move("stand", { time_s = 1.5 }):wait()
      m.vars.done = m.vars.done + 1
    end,
    { on = "run.done", to = "rest" },
  },
  k.state "rest" {
    { after = 1, to = "done" },
  },
  k.final "done" { outcome = "done" },
}

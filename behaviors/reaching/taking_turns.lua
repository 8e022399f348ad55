-- Led by tasks of the whole body and joint by joint in turns, each taking over from the other in the middle of a motion.
local k = require "kadans"

local P = k.params {
  turns = { 6, min = 1, max = 100, doc = "how often it is led by tasks" },
}

return k.behavior "taking_turns" {
  vars    = { turns = 0 },
  initial = "tasks",
  always  = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "tasks" {
    controls = "body",
    run = function(m)
      m.vars.turns = m.vars.turns + 1
      m:wait(0.3)
      local low_m = m.body:setpoint("com_z_m") - 0.03
      m.body:move({ com_m = { nil, nil, low_m }, trunk = { pitch_rad = 0.15 } }, { time_s = 0.8 })
      m:wait(0.5)
    end,
    { on = "run.done", to = "joints" },
  },
  k.state "joints" {
    controls = "posture",
    enter = function(m) m.posture:move("stand", { time_s = 0.8 }) end,
    { when = function(_, m) return m.vars.turns >= P.turns end, after = 2.0, to = "done" },
    { when = function(_, m) return m.vars.turns < P.turns end, after = 0.55, to = "tasks" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

-- Reaches forward and down with a hand: sinks, shifts its weight, leans and stretches the arm, each a task of the whole
-- body; then it stands again. What it cannot reach it says before it moves.
local k = require "kadans"

local P = k.params {
  side_m    = { 0.04, min = -0.05, max = 0.05, unit = "m", doc = "how far the weight goes to the left" },
  sink_m    = { 0.06, min = 0, max = 0.1, unit = "m", doc = "how far the centre of mass goes down" },
  lean_rad  = { 0.35, min = -0.2, max = 0.5, unit = "rad", doc = "how far the trunk leans forward" },
  forward_m = { 0.38, min = 0, max = 2, unit = "m", doc = "where the right hand goes, forward of the feet's middle" },
  height_m  = { 0.55, min = 0, max = 2, unit = "m", doc = "and over the ground" },
  time_s    = { 1.5, min = 0.5, max = 10, unit = "s", doc = "time of each motion" },
  hold_s    = { 1.0, min = 0, max = 10, unit = "s", doc = "time to stay there" },
}

return k.behavior "reach" {
  controls = "body",
  vars     = { height_m = 0, pitch_rad = 0 },
  initial  = "settle",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "settle" {
    { after = 0.5, to = "shift" },
  },
  k.state "shift" {
    run = function(m)
      m.vars.height_m = m.body:setpoint("com_z_m")
      m.vars.pitch_rad = m.body:setpoint("trunk.pitch_rad")
      local over = { com_m = { nil, P.side_m, m.vars.height_m - P.sink_m } }
      m.body:move(over, { time_s = P.time_s, contacts = { "left", "right" } })
      m:wait(P.time_s + P.hold_s)
    end,
    { on = "run.done", to = "reach" },
  },
  k.state "reach" {
    run = function(m)
      m.body:move({ trunk = { pitch_rad = P.lean_rad } }, { time_s = P.time_s }):wait()
      local hand = { hand_right_m = { P.forward_m, m.body:setpoint("hand_right_y_m"), P.height_m } }
      local motion, why, distance_m = m.body:move(hand, { time_s = P.time_s, weight = 30 })
      if why == "out_of_reach" then
        k.log.warning("the hand would stay %.2f m short", distance_m)
      elseif motion then
        m:wait(P.time_s + P.hold_s)
      end
    end,
    { on = "run.done", to = "back" },
  },
  k.state "back" {
    run = function(m)
      m.body:set_parameter("hand_right.weight", 0)
      m.body:move({ com_m = { nil, 0, m.vars.height_m }, trunk = { pitch_rad = m.vars.pitch_rad } }, { time_s = P.time_s })
      m:wait(P.time_s + P.hold_s)
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

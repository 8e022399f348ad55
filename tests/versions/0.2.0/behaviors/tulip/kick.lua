-- Kicks a ball that lies where it is told, within its steps, and comes to stand.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  ball_x_m    = { 0.3, min = 0, max = 3, unit = "m", doc = "the ball, ahead of the robot" },
  ball_y_m    = { 0.09, min = -1, max = 1, unit = "m", doc = "to the left" },
  left        = { 1, min = 0, max = 1, doc = "1: with the left foot, 0: with the right one" },
  rad         = { 0, min = -0.55, max = 0.55, unit = "rad", doc = "where it shall go, to the left" },
  far_m       = { 3, min = 0.3, max = 4.5, unit = "m", doc = "how far it shall roll" },
  roll_m_s2   = { 0.28, min = 0.01, max = 5, unit = "m/s2", doc = "how the ground slows a ball" },
  within_s    = { 10, min = 1, max = 100, unit = "s", doc = "longest time until the kick" },
  steps_s     = { 0.6, min = 0, max = 10, unit = "s", doc = "time in place after it, before it stands" },
}

-- Steps to where the ball lies before a foot, if it does not.
local function come(m)
  local side = P.left > 0.5 and 1 or -1
  walk.beside(m, walk.to_kick({ x_m = P.ball_x_m, y_m = P.ball_y_m }, P.rad, side, 0))
end

return k.behavior "kick" {
  controls = "walking",
  initial  = "set_out",

  k.state "set_out" {
    run = function(m) walk.set_out(m, P.settle_s) end,
    { on = "run.done", to = "kick" },
  },
  k.state "kick" {
    run = function(m)
      walk.here(m, {})
      m:wait(0.02)
      local kicks, why = walk.kick(m, { x_m = P.ball_x_m, y_m = P.ball_y_m }, P.rad, P.far_m, P.roll_m_s2)
      if not kicks then k.log.error("no kick: %s", why) end
      walk.go(m, {})
      m:wait(0.02)
      while walk.kicks(m) do
        come(m)
        m:wait(0.01)
      end
      walk.go(m, {})
      m:wait(P.steps_s)
    end,
    { on = "run.done", to = "stop" },
    { after = P.within_s, to = "stop", action = walk.keep, why = "no ball" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = function(_, m) return m.vars.stands end, to = "stands" },
  },
  k.final "stands" { outcome = "done" },
}

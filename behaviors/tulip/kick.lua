-- Kicks a ball that lies where it is told, within its steps, and stands.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s   = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  ball_x_m   = { 0.3, min = 0, max = 3, unit = "m", doc = "the ball, before the robot" },
  ball_y_m   = { 0.09, min = -1, max = 1, unit = "m", doc = "to the left" },
  kick_rad   = { 0, min = -0.6, max = 0.6, unit = "rad", doc = "where it shall go, to the left" },
  foot_m_s   = { 1.2, min = 0.1, max = 3, unit = "m/s", doc = "speed of the foot" },
}

return k.behavior "kick" {
  controls = "walking",
  initial  = "set_out",

  k.state "set_out" {
    run = function(m)
      m.posture:set_gains("stiff")
      m.posture:move("set_out", { time_s = P.settle_s })
      m:wait(P.settle_s)
    end,
    { on = "run.done", to = "kick" },
  },
  k.state "kick" {
    enter = function(m)
      walk.here(m, {})
      m.walk:set("kick_x_m", P.ball_x_m)
      m.walk:set("kick_y_m", P.ball_y_m)
      m.walk:set("kick_rad", P.kick_rad)
      m.walk:set("kick_m_s", P.foot_m_s)
      walk.go(m, {})
    end,
    during = function(m) m.vars.kicked = m.time_s > 0.1 and m.walk:setpoint("kick_m_s") == 0 end,
    { when = function(_, m) return m.vars.kicked end, to = "stop" },
    { after = 5, to = "stop" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = function(_, m) return m.vars.stands end, to = "stands" },
  },
  k.final "stands" { outcome = "done" },
}

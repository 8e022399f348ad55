-- Walks at a given velocity.
local k = require "kadans"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  forward_m_s = { 0.2, min = -0.5, max = 0.8, unit = "m/s", doc = "velocity forward" },
  left_m_s    = { 0, min = -0.4, max = 0.4, unit = "m/s", doc = "velocity to the left" },
  turn_rad_s  = { 0, min = -1.5, max = 1.5, unit = "rad/s", doc = "turning to the left" },
}

return k.behavior "walk" {
  controls = "walking",
  initial  = "go",

  k.state "go" {
    endless = true,
    run = function(m)
      m.posture:move("set_out", { time_s = P.settle_s })
      m:wait(P.settle_s)
      m.walk:set("forward_m_s", P.forward_m_s)
      m.walk:set("left_m_s", P.left_m_s)
      m.walk:set("turn_rad_s", P.turn_rad_s)
      m.walk:set("go", 1)
    end,
  },
}

-- Walks as a joystick says: away from the hand is forward, right is to the right, twisted is turned. With the stick let
-- go, or unplugged, it comes to stand. A stick in a corner asks for more than it walks at once: then it goes that way, slower.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  forward_m_s = { 0.4, min = 0.05, max = 0.6, unit = "m/s", doc = "velocity forward at the stick's end" },
  back_m_s    = { 0.15, min = 0.05, max = 0.2, unit = "m/s", doc = "velocity backward" },
  side_m_s    = { 0.08, min = 0.02, max = 0.15, unit = "m/s", doc = "velocity to a side" },
  turn_rad_s  = { 0.4, min = 0.1, max = 0.8, unit = "rad/s", doc = "how fast it turns" },
  rest        = { 0.05, min = 0, max = 0.5, doc = "of the stick's way, within which it counts as let go" },
}

return k.behavior "walk_stick" {
  controls = "walking",
  initial  = "set_out",

  k.state "set_out" {
    enter = function(m) m.posture:move("set_out", { time_s = P.settle_s }) end,
    { after = P.settle_s, to = "walk" },
  },
  k.state "walk" {
    endless = true,
    during = function(m, s)
      local stick = s.joystick
      if math.max(math.abs(stick.x), math.abs(stick.y), math.abs(stick.twist)) < P.rest then return walk.stop(m) end
      assert(walk.go(m, walk.slowed {
        forward_m_s = stick.y * (stick.y < 0 and P.back_m_s or P.forward_m_s),
        left_m_s = -stick.x * P.side_m_s,
        turn_rad_s = -stick.twist * P.turn_rad_s,
      }))
    end,
    exit = walk.stop,
  },
}

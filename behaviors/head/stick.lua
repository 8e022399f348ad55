-- The joystick task of 2008. Ten times a second the stick's x and y become the velocity of a target 1 m ahead, and its
-- twist that of the distance. The first button brings the target back ahead. Let go or unplugged, it stays there.
local k = require "kadans"

local P = k.params {
  velocity_m_s = { 0.4, min = 0, max = 3, unit = "m/s", doc = "of the target at the stick's end" },
  side_m       = { 1.0, min = 0, max = 5, unit = "m", doc = "no farther to a side, up or down" },
  nearest_m    = { 0.4, min = 0.2, max = 1, unit = "m", doc = "no nearer to the base" },
  farthest_m   = { 3.0, min = 1, max = 10, unit = "m", doc = "no farther from the base" },
}

local period_s = 0.1
local ahead = { x_m = 1.08, y_m = 0, z_m = 0.22 }

-- Stops where the target would pass its bounds.
local function go(gaze, direction, velocity_m_s, lowest_m, highest_m)
  local at_m = gaze:setpoint(direction .. "_m")
  if (velocity_m_s < 0 and at_m < lowest_m) or (velocity_m_s > 0 and at_m > highest_m) then velocity_m_s = 0 end
  gaze:set(direction .. "_m_s", velocity_m_s)
end

return k.behavior "stick" {
  controls = "gaze",
  initial  = "held",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "held" {
    run = function(m, s)
      while true do
        go(m.gaze, "x", P.velocity_m_s * s.joystick.twist, P.nearest_m, P.farthest_m)
        go(m.gaze, "y", -P.velocity_m_s * s.joystick.x, -P.side_m, P.side_m)
        go(m.gaze, "z", P.velocity_m_s * s.joystick.y, -P.side_m, P.side_m)
        m:wait(period_s)
      end
    end,
    { when = function(s) return s.joystick.button_1 end, to = "back", why = "button 1" },
  },
  k.state "back" {
    run = function(m)
      for _, direction in ipairs { "x", "y", "z" } do m.gaze:set(direction .. "_m_s", 0) end
      for setpoint, value_m in pairs(ahead) do m.gaze:set(setpoint, value_m, { time_s = 0.5 }) end
      m:wait(0.5)
    end,
    { on = "run.done", to = "held" },
  },
  k.final "failed" { outcome = "failed" },
}

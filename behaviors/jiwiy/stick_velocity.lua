-- The joystick task of 2008. Ten times a second the stick's x and y become the rates of pan and tilt. Stick right turns
-- the camera right; stick away from the hand turns it up. Let go or unplugged, the camera comes to rest.
local k = require "kadans"

local P = k.params {
  rate_rad_s = { 1.5, min = 0, max = 5, unit = "rad/s", doc = "rate at the stick's end" },
}

local period_s = 0.1

return k.behavior "stick_velocity" {
  controls = "velocity",
  initial  = "held",

  k.state "held" {
    endless = true,
    run = function(m, s)
      while true do
        m.rate:set("pan.velocity_rad_s", -P.rate_rad_s * s.joystick.x, { time_s = period_s })
        m.rate:set("tilt.velocity_rad_s", -P.rate_rad_s * s.joystick.y, { time_s = period_s })
        m:wait(period_s)
      end
    end,
  },
}

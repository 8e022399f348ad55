-- The stick means a pose. Ten times a second its x and y become the positions of pan and tilt, reached within the
-- profile's limits. When the stick is let go, the camera looks ahead.
local k = require "kadans"

local P = k.params {
  pan_rad  = { 1.2, min = 0, max = 2.5, unit = "rad", doc = "pan at the stick's end" },
  tilt_rad = { 0.6, min = 0, max = 0.75, unit = "rad", doc = "tilt at the stick's end" },
}

local period_s = 0.1

return k.behavior "stick_position" {
  controls = "position",
  initial  = "held",

  k.state "held" {
    endless = true,
    run = function(m, s)
      while true do
        m.profile:set("pan.position_rad", -P.pan_rad * s.joystick.x)
        m.profile:set("tilt.position_rad", -P.tilt_rad * s.joystick.y)
        m:wait(period_s)
      end
    end,
  },
}

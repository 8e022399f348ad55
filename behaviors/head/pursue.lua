-- The target swings from left to right and, with a smaller amplitude, up and down, 1 m away from the eyes.
local k = require "kadans"

local P = k.params {
  side_m       = { 0.3, min = 0, max = 2, unit = "m", doc = "amplitude to the side" },
  height_m     = { 0.1, min = 0, max = 1, unit = "m", doc = "amplitude of the height, at twice the frequency" },
  frequency_Hz = { 0.5, min = 0.05, max = 2, unit = "Hz", doc = "how often it comes back" },
  distance_m   = { 1.0, min = 0.3, max = 10, unit = "m", doc = "ahead of the eyes" },
  lasts_s      = { 9, min = 1, max = 600, unit = "s", doc = "how long it swings" },
}

local eyes_x_m, eyes_z_m = 0.08, 0.22

return k.behavior "pursue" {
  controls = "gaze",
  initial  = "swing",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "swing" {
    enter = function(m)
      m.gaze:set("x_m", eyes_x_m + P.distance_m)
      m.gaze:set("z_m", eyes_z_m)
    end,
    during = function(m)
      local w = 2 * math.pi * P.frequency_Hz
      m.gaze:set("y_m", P.side_m * math.sin(w * m.time_s))
      m.gaze:set("y_m_s", P.side_m * w * math.cos(w * m.time_s))
      m.gaze:set("z_m", eyes_z_m + P.height_m * math.sin(2 * w * m.time_s))
      m.gaze:set("z_m_s", P.height_m * 2 * w * math.cos(2 * w * m.time_s))
    end,
    { after = P.lasts_s, to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

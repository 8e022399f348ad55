-- Looks at the point that its parameters give, also while they change. A scenario sets them with `look_at{y_m=0.3}`,
-- a run with `kadans ctl set look_at.y_m 0.3` or from the page.
local k = require "kadans"

local P = k.params {
  x_m    = { 1.08, min = -5, max = 5, unit = "m", doc = "forward of the base" },
  y_m    = { 0, min = -5, max = 5, unit = "m", doc = "left of the base" },
  z_m    = { 0.22, min = -5, max = 5, unit = "m", doc = "above the base" },
  time_s = { 0, min = 0, max = 10, unit = "s", doc = "in which the target goes there; 0: it jumps, the eyes make a saccade" },
}

local function moved(v) return v.x_m ~= P.x_m or v.y_m ~= P.y_m or v.z_m ~= P.z_m end

return k.behavior "look_at" {
  controls = "gaze",
  vars     = { x_m = false, y_m = false, z_m = false },
  initial  = "look",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "look" {
    endless = true,
    during = function(m)
      if not moved(m.vars) then return end
      for _, direction in ipairs { "x_m", "y_m", "z_m" } do
        m.vars[direction] = P[direction]
        if P.time_s > 0 then
          m.gaze:set(direction, P[direction], { time_s = P.time_s })
        else
          m.gaze:set(direction, P[direction])
        end
      end
    end,
  },
  k.final "failed" { outcome = "failed" },
}

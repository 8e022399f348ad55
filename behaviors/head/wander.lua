-- Targets that the head cannot look at, or only just: under its back, behind it, above it, beside it along the eyes'
-- axis, very near. The head goes as near to each as it can, and ends looking ahead again.
local k = require "kadans"

local P = k.params {
  rest_s = { 3.5, min = 0.5, max = 60, unit = "s", doc = "time at each target" },
}

local targets = {
  { x = -0.4, y = 0.0, z = -0.3, name = "under its back" },
  { x = 1.08, y = 0.0, z = 0.22, name = "ahead" },
  { x = -1.0, y = 0.0, z = 0.22, name = "behind" },
  { x = 0.08, y = 0.0, z = 1.22, name = "above" },
  { x = 0.08, y = 1.0, z = 0.22, name = "beside" },
  { x = 0.2, y = 0.0, z = 0.22, name = "near" },
  { x = 1.08, y = 0.0, z = 0.22, name = "ahead" },
}

return k.behavior "wander" {
  controls = "gaze",
  initial  = "look",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "look" {
    run = function(m)
      for _, target in ipairs(targets) do
        k.log.info("%s", target.name)
        m.gaze:set("x_m", target.x)
        m.gaze:set("y_m", target.y)
        m.gaze:set("z_m", target.z)
        m:wait(P.rest_s)
      end
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

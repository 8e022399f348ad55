-- The target jumps from side to side and up and down, 30 degrees and more at a time, 1 m away from the eyes.
local k = require "kadans"

local P = k.params {
  angle_deg = { 15, min = 1, max = 60, unit = "deg", doc = "how far to each side" },
  rest_s    = { 1.5, min = 0.3, max = 60, unit = "s", doc = "time at each target" },
  rounds    = { 1, min = 1, max = 100, doc = "how often all targets are looked at" },
}

-- Where the eyes are when the head is upright.
local eyes_x_m, eyes_z_m = 0.08, 0.22
local directions = { { 0, 0 }, { 1, 0 }, { -1, 0 }, { 1, 0.5 }, { -1, -0.5 }, { 0, 1 }, { 0, -1 }, { 0, 0 } }

local function look(gaze, yaw_rad, pitch_rad)
  gaze:set("x_m", eyes_x_m + math.cos(pitch_rad) * math.cos(yaw_rad))
  gaze:set("y_m", math.cos(pitch_rad) * math.sin(yaw_rad))
  gaze:set("z_m", eyes_z_m + math.sin(pitch_rad))
end

return k.behavior "saccade" {
  controls = "gaze",
  initial  = "look",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "look" {
    run = function(m)
      local unit_rad = math.rad(P.angle_deg)
      for _ = 1, P.rounds do
        for _, direction in ipairs(directions) do
          look(m.gaze, unit_rad * direction[1], unit_rad * direction[2])
          m:wait(P.rest_s)
        end
      end
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

-- Waves with one arm, as a list of key frames.
local k = require "kadans"
local frames = require "frames"

local P = k.params {
  height_rad = { 1.8, min = 0.3, max = 2.5, unit = "rad", doc = "how far the arm is raised" },
  swing_rad  = { 0.3, min = 0, max = 0.6, unit = "rad", doc = "how far it waves to and fro" },
  beat_s     = { 0.6, min = 0.4, max = 5, unit = "s", doc = "time of one swing" },
}

local function greeting()
  local function arm(position_rad) return { r_shoulder_pitch = position_rad } end
  return {
    { pose = arm(-P.height_rad), time_s = 1.2 },
    { pose = arm(-P.height_rad - P.swing_rad), time_s = P.beat_s },
    { pose = arm(-P.height_rad + P.swing_rad), time_s = P.beat_s },
    { pose = arm(-P.height_rad), time_s = P.beat_s, hold_s = 0.3 },
    { pose = "stand", time_s = 1.2 },
  }
end

return k.behavior "wave" {
  controls = "posture",
  initial  = "wave",
  k.state "wave" {
    run = function(m)
      local played, why = frames.play(m, m.posture, greeting())
      m:emit(played and "greeted" or "refused:" .. why)
    end,
    { on = "greeted", to = "done" },
    { after = 20, to = "failed", why = "took too long" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

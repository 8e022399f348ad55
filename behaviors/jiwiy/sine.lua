-- Moves both joints along a sine, and measures how well they follow: amplitude and phase, by correlation over whole
-- periods. Ten times a second it gives the points of the next 0.8 s; the control engine draws the curve through them.
local k = require "kadans"

local P = k.params {
  pan_rad       = { 0.6, min = 0.05, max = 2, unit = "rad", doc = "amplitude of the pan joint" },
  tilt_rad      = { 0.4, min = 0.05, max = 0.7, unit = "rad", doc = "amplitude of the tilt joint" },
  frequency_Hz  = { 1.0, min = 0.1, max = 1.5, unit = "Hz", doc = "of both" },
  settle_s      = { 2.0, min = 1, max = 20, unit = "s", doc = "time in which the amplitude grows and transients fade" },
  periods       = { 4, min = 1, max = 100, doc = "whole periods that are measured" },
  gain_error    = { 0.05, min = 0, max = 1, doc = "amplitude that may be amiss, as a share" },
  phase_deg     = { 5, min = 0, max = 90, unit = "deg", doc = "phase that may be amiss" },
}

local points_s, points = 0.1, 8
local joints = { "pan", "tilt" }

local function amplitude_rad(joint) return joint == "pan" and P.pan_rad or P.tilt_rad end
local function angle(time_s) return 2 * math.pi * P.frequency_Hz * time_s end

-- Grows within the first second, so that nothing jumps.
local function at(joint, time_s)
  local grown = math.min(1, time_s)
  return amplitude_rad(joint) * grown * grown * (3 - 2 * grown) * math.sin(angle(time_s))
end

local function ahead(time_s)
  local list = {}
  for i = 1, points do
    local pose = {}
    for _, joint in ipairs(joints) do pose[joint] = at(joint, time_s + i * points_s) end
    list[i] = { pose, time_s = points_s }
  end
  return list
end

local function correlate(v, s, time_s)
  for _, joint in ipairs(joints) do
    local position_rad = s.joints[joint].position_rad
    v[joint .. "_sin"] = v[joint .. "_sin"] + position_rad * math.sin(angle(time_s))
    v[joint .. "_cos"] = v[joint .. "_cos"] + position_rad * math.cos(angle(time_s))
  end
  v.samples = v.samples + 1
end

local function judge(v)
  local good = true
  for _, joint in ipairs(joints) do
    local sin, cos = 2 * v[joint .. "_sin"] / v.samples, 2 * v[joint .. "_cos"] / v.samples
    local gain = math.sqrt(sin * sin + cos * cos) / amplitude_rad(joint)
    local phase_deg = math.deg(math.atan2(cos, sin))
    k.log.info("%s: gain %.4f, phase %.2f deg", joint, gain, phase_deg)
    good = good and math.abs(gain - 1) <= P.gain_error and math.abs(phase_deg) <= P.phase_deg
  end
  if not good then k.log.error("does not follow the sine") end
  return good
end

return k.behavior "sine" {
  controls = "effort",
  vars     = { start_s = 0, next_s = 0, samples = 0, pan_sin = 0, pan_cos = 0, tilt_sin = 0, tilt_cos = 0 },
  initial  = "ahead",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "ahead" {
    run = function(m) m.torque:move("ahead", { time_s = 0.8 }):wait() end,
    { on = "run.done", to = "follow" },
  },
  k.state "follow" {
    enter = function(m, s)
      m.vars.start_s = s.time_s
      m.vars.next_s = s.time_s
    end,
    during = function(m, s)
      local v, time_s = m.vars, s.time_s - m.vars.start_s
      if s.time_s >= v.next_s - 0.001 then
        m.torque:move_through(ahead(time_s))
        v.next_s = v.next_s + points_s
      end
      local measured_s = time_s - P.settle_s
      if measured_s >= -0.001 and measured_s < P.periods / P.frequency_Hz - 0.001 then correlate(v, s, time_s) end
      if measured_s >= P.periods / P.frequency_Hz and v.samples > 0 then
        m:emit(judge(v) and "follows" or "lags")
        v.samples = 0
      end
    end,
    { on = "follows", to = "done" },
    { on = "lags", to = "failed", why = "amplitude or phase" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

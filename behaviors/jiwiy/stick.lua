-- JIWIY follows a joystick, the task of 2008. The first three buttons choose whether the stick means a pose, a rate or a
-- path, also while the camera moves: each is a state with a control set of its own. Ten times a second the stick's x and
-- y are read. Stick right turns the camera right; stick away from the hand turns it up. Let go or unplugged, the camera
-- looks ahead or comes to rest.
local k = require "kadans"

local P = k.params {
  pan_rad       = { 1.2, min = 0, max = 2.5, unit = "rad", doc = "pan at the stick's end" },
  tilt_rad      = { 0.6, min = 0, max = 0.75, unit = "rad", doc = "tilt at the stick's end" },
  rate_rad_s    = { 1.5, min = 0, max = 5, unit = "rad/s", doc = "rate at the stick's end" },
  change_rad_s2 = { 4, min = 0.1, max = 10, unit = "rad/s2", doc = "how fast the rate changes along a path" },
}

local period_s, points = 0.1, 8
local end_rad = { pan = 2.4, tilt = 0.7 }

local function poses(s) return s.joystick.button_1 end
local function turns(s) return s.joystick.button_2 end
local function leads(s) return s.joystick.button_3 end

local function within(joint, position_rad)
  return math.max(-end_rad[joint], math.min(end_rad[joint], position_rad))
end

local function towards(rate_rad_s, wanted_rad_s)
  local most = P.change_rad_s2 * period_s
  return rate_rad_s + math.max(-most, math.min(most, wanted_rad_s - rate_rad_s))
end

-- The points of the next 0.8 s at these rates, from those that `path` has come to by the first.
local function ahead(path, rate)
  local list = {}
  for i = 1, points do
    local pose = {}
    for joint, position_rad in pairs(path) do
      pose[joint] = within(joint, position_rad + (i - 1) * period_s * rate[joint])
    end
    list[i] = { pose, time_s = period_s }
  end
  return list
end

return k.behavior "stick" {
  initial = "velocity",
  always  = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  -- The stick means a pose, reached within the profile's limits.
  k.state "position" {
    controls = "position",
    run = function(m, s)
      while true do
        m.profile:set("pan.position_rad", -P.pan_rad * s.joystick.x)
        m.profile:set("tilt.position_rad", -P.tilt_rad * s.joystick.y)
        m:wait(period_s)
      end
    end,
    { when = turns, to = "velocity", why = "button 2" },
    { when = leads, to = "effort", why = "button 3" },
  },

  -- The stick means the rates of pan and tilt.
  k.state "velocity" {
    controls = "velocity",
    run = function(m, s)
      while true do
        m.rate:set("pan.velocity_rad_s", -P.rate_rad_s * s.joystick.x, { time_s = period_s })
        m.rate:set("tilt.velocity_rad_s", -P.rate_rad_s * s.joystick.y, { time_s = period_s })
        m:wait(period_s)
      end
    end,
    { when = poses, to = "position", why = "button 1" },
    { when = leads, to = "effort", why = "button 3" },
  },

  -- The stick leads along a path: it says how the path goes on for the next 0.8 s, and a control object follows it by
  -- torques. The rate changes gently, and begins with that of the joints.
  k.state "effort" {
    controls = "effort",
    run = function(m, s)
      local axes, path, rate = { pan = "x", tilt = "y" }, {}, {}
      for joint in pairs(axes) do
        path[joint], rate[joint] = s.joints[joint].position_rad, s.joints[joint].velocity_rad_s
      end
      while true do
        for joint, axis in pairs(axes) do
          local before = rate[joint]
          rate[joint] = towards(before, -P.rate_rad_s * s.joystick[axis])
          path[joint] = within(joint, path[joint] + period_s * (before + rate[joint]) / 2)
        end
        m.torque:move_through(ahead(path, rate))
        m:wait(period_s)
      end
    end,
    { when = poses, to = "position", why = "button 1" },
    { when = turns, to = "velocity", why = "button 2" },
  },

  k.final "failed" { outcome = "failed" },
}

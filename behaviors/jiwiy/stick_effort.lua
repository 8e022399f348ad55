-- The stick leads along a path. Ten times a second its x and y say how the path goes on for the next 0.8 s; a control
-- object follows it by torques. The rate changes gently, and begins with that of the joints. Let go, it comes to rest.
local k = require "kadans"

local P = k.params {
  rate_rad_s    = { 1.5, min = 0, max = 5, unit = "rad/s", doc = "rate at the stick's end" },
  change_rad_s2 = { 4, min = 0.1, max = 10, unit = "rad/s2", doc = "how fast the rate changes" },
}

local period_s, points = 0.1, 8
local end_rad = { pan = 2.4, tilt = 0.7 }

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

return k.behavior "stick_effort" {
  controls = "effort",
  initial  = "held",

  k.state "held" {
    endless = true,
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
  },
}

-- Walks as somebody outside leads it, by the event cmd_vel: `kadans ctl emit cmd_vel forward_m_s=0.3`, or ROS 2's
-- /cmd_vel. What it cannot do it says, and goes on as before. When nobody says anything for a while, it comes to stand.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s   = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  patience_s = { 0.5, min = 0.05, max = 60, unit = "s", doc = "without a word from outside, after which it stops" },
  rest       = { 0.01, min = 0, max = 0.1, doc = "velocities below, in m/s and rad/s, are none: it stands" },
}

k.events {
  cmd_vel = {
    "how fast it shall walk",
    forward_m_s = { "m/s", optional = true },
    left_m_s    = { "m/s", optional = true },
    turn_rad_s  = { "rad/s", optional = true },
  },
}

local function lead(m, s)
  local way = s.event.data
  local most = 0
  for _, value in pairs(way) do most = math.max(most, math.abs(value)) end
  if most <= P.rest then return walk.stop(m) end
  local goes, why = walk.go(m, way)
  if not goes and why ~= m.vars.why then k.log.warning("it goes on as before: %s", why) end
  m.vars.why = why
end

return k.behavior "walk_led" {
  controls = "walking",
  initial  = "set_out",

  k.state "set_out" {
    enter = function(m) m.posture:move("set_out", { time_s = P.settle_s }) end,
    { after = P.settle_s, to = "waits" },
  },
  k.state "waits" {
    endless = true,
    { on = "cmd_vel", to = "led", action = lead },
  },
  k.state "led" {
    { on = "cmd_vel", to = "led", action = lead },
    { after = P.patience_s, to = "waits", why = "nobody leads it", action = walk.stop },
  },
}

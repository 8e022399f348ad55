-- Walks at a velocity for some time, then comes to stand. When a motor gets warm it walks higher: straighter knees bear the
-- weight with less torque. When the robot falls, it gets up and walks on.
local k = require "kadans"
local floor = require "floor"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  forward_m_s = { 0.3, min = -0.25, max = 0.65, unit = "m/s", doc = "velocity forward" },
  left_m_s    = { 0, min = -0.2, max = 0.2, unit = "m/s", doc = "velocity to the left" },
  turn_rad_s  = { 0, min = -1, max = 1, unit = "rad/s", doc = "turning to the left" },
  for_s       = { 1e5, min = 0, max = 1e5, unit = "s", doc = "how long it walks" },
  warm_m      = { 0.525, min = 0.4, max = 0.6, unit = "m", doc = "height of the centre of mass once a motor is warm" },
}

local function lies(s) return floor.lies(s.base) end
local function stands(_, m) return m.vars.stands end

local function rise(m)
  if m.walk:parameter("height_m") >= P.warm_m then return end
  k.log.info("a motor is warm: it walks higher")
  m.walk:set_parameter("height_m", P.warm_m)
end

return k.behavior "walk" {
  controls = "walking",
  vars     = { height_m = 0, stands = false },
  initial  = "set_out",
  enter    = function(m) m.vars.height_m = m.walk:parameter("height_m") end,
  exit     = function(m) m.walk:set_parameter("height_m", m.vars.height_m) end,
  always   = { { on = "fault.motor_warm", action = rise } },

  k.state "set_out" {
    run = function(m) walk.set_out(m, P.settle_s) end,
    { on = "run.done", to = "go" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "go" {
    enter = function(m)
      local goes, why = walk.go(m, { forward_m_s = P.forward_m_s, left_m_s = P.left_m_s, turn_rad_s = P.turn_rad_s })
      if not goes then k.log.error("it stays: %s", why) end
    end,
    { after = P.for_s, to = "stop" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = stands, to = "stands" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "fallen" {
    enter = walk.stop,
    k.call "get_up",
    { on = "done", to = "set_out" },
    { on = "failed", to = "failed" },
  },
  k.final "stands" { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

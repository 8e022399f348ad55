-- Stays up, whatever pushes it, and does the least that helps. Ankles, trunk and arms hold what they can ("stance"), and
-- to the sides that is much, because the feet are far apart. What takes the weight further is caught by steps ("walk"), as
-- few as it takes; then the robot stands again. When it falls nevertheless, it falls softly and gets up. With `go` it
-- walks meanwhile, or steps in place.
local k = require "kadans"
local floor = require "floor"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.5, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  bear_s      = { 0.25, min = 0, max = 5, unit = "s", doc = "time until the legs bear by force, and the pose gives way" },
  front_m     = { 0.1, min = 0, max = 0.5, unit = "m", doc = "how far ahead its weight may go before it steps" },
  back_m      = { 0.075, min = 0, max = 0.5, unit = "m", doc = "the same backward; from the middle between its feet" },
  side_m      = { 0.14, min = 0, max = 0.5, unit = "m", doc = "the same to either side" },
  go          = { 0, min = 0, max = 1, doc = "1: it walks, or steps in place; 0: it stands while it can" },
  forward_m_s = { 0, min = -0.25, max = 0.65, unit = "m/s", doc = "velocity forward, with go" },
  left_m_s    = { 0, min = -0.2, max = 0.2, unit = "m/s", doc = "velocity to the left" },
  turn_rad_s  = { 0, min = -1, max = 1, unit = "rad/s", doc = "turning to the left" },
}

local function lies(s) return floor.lies(s.base) end
local function goes() return P.go >= 0.5 end
local function stays() return P.go < 0.5 end
local function stands(_, m) return m.vars.stands end

local function in_place() return P.forward_m_s == 0 and P.left_m_s == 0 and P.turn_rad_s == 0 end

-- The walk bears; the posture holds the arms, and the legs once it has stopped.
local function take_over(m)
  m.stance:set_parameter("share", 0)
  m.posture:set_gains("stiff")
  m.posture:move("keep", { time_s = P.settle_s })
end

return k.behavior "keep_up" {
  controls = "upright",
  vars     = { stands = false },
  initial  = "stand",

  k.state "stand" {
    enter = function(m)
      m.walk:set_gains("catch")
      walk.meant(m, {})
    end,
    run = function(m)
      m.posture:move("keep", { time_s = P.settle_s })
      m.stance:set_parameter("share", 1)
      m:wait(P.bear_s)
      m.balance:set_parameter("share", 0)
      m.posture:set_gains("balance")
      m:wait(P.settle_s)
      local beyond = {
        "control.stance.dcm_x_m > " .. P.front_m,
        "control.stance.dcm_x_m < " .. -P.back_m,
        "control.stance.dcm_y_m > " .. P.side_m,
        "control.stance.dcm_y_m < " .. -P.side_m,
      }
      m:on({ any = beyond }, function(c) c.walk:set("go", 1) end, { within_s = 3600, event = "beyond_its_soles" })
    end,
    { on = "beyond_its_soles", to = "step" },
    { when = lies, to = "fallen", why = "lies" },
    { when = goes, after = 1, to = "go" },
  },
  k.state "go" {
    enter = function(m)
      take_over(m)
      m.walk:set_gains(in_place() and "in_place" or "usual")
      local way = { forward_m_s = P.forward_m_s, left_m_s = P.left_m_s, turn_rad_s = P.turn_rad_s }
      local gone, why = walk.go(m, way)
      if not gone then k.log.error("it stays: %s", why) end
    end,
    { when = lies, to = "fallen", why = "lies" },
    { when = stays, to = "step" },
  },
  k.state "step" {
    enter = function(m)
      take_over(m)
      walk.stop(m)
      m.vars.stands = false
    end,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = lies, to = "fallen", why = "lies" },
    { when = goes, to = "go" },
    { when = stands, to = "stand" },
  },
  k.state "fallen" {
    enter = function(m)
      walk.stop(m)
      m.stance:set_parameter("share", 0)
    end,
    k.call "get_up",
    { on = "done", to = "stand" },
    { on = "failed", to = "failed" },
  },
  k.final "failed" { outcome = "failed" },
}

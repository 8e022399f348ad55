-- Goes to the ball that it sees, around it, and kicks it toward a place; again, when it is still on this side.
local k = require "kadans"
local ball = require "ball"
local floor = require "floor"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  target_x_m  = { 4, min = -20, max = 20, unit = "m", doc = "where the ball shall go, counted from where it sets out" },
  target_y_m  = { 0, min = -20, max = 20, unit = "m", doc = "to the left" },
  beyond_m    = { 1.5, min = 0, max = 4, unit = "m", doc = "how far beyond it the kick would roll" },
  roll_m_s2   = { 0.28, min = 0.01, max = 5, unit = "m/s2", doc = "how the ground slows a ball" },
  watch_s     = { 2.5, min = 0.5, max = 20, unit = "s", doc = "how long it watches the ball that it kicked" },
  lost_s      = { 2, min = 0.1, max = 20, unit = "s", doc = "a ball not seen for so long is looked for" },
}

local function approach(m, b)
  ball.approach(m, b, { x_m = P.target_x_m, y_m = P.target_y_m }, P.beyond_m, P.roll_m_s2)
end

-- The ball is beyond the target, and its radius with it. From afar the robot sees that by noisy pictures.
local function is_there(m, b)
  local x_m, y_m = P.target_x_m, P.target_y_m
  local beyond_m = (x_m * (b.x_m - x_m) + y_m * (b.y_m - y_m)) / math.sqrt(x_m ^ 2 + y_m ^ 2)
  return beyond_m > 0.1 + 0.05 * walk.distance(b, walk.at(m))
end

local function look(m, s)
  local b = ball.watch(m, s, m.vars.known)
  m.vars.sees = b ~= nil and s.time_s - b.seen_s < P.lost_s
  m.vars.there = b ~= nil and is_there(m, b)
  return b
end

local function lies(s) return floor.lies(s.base) end
local function there(_, m) return m.vars.there end

return k.behavior "go_to_ball" {
  controls = "walking",
  initial  = "set_out",
  vars     = { known = {}, side = 1, sees = false, there = false, armed = false, kicked = false, stands = false },

  k.state "set_out" {
    run = function(m) walk.set_out(m, P.settle_s) end,
    { on = "run.done", to = "search" },
  },
  k.state "search" {
    enter = function(m) ball.search(m, m.vars.known) end,
    during = look,
    { when = lies, to = "fallen", why = "lies" },
    { when = there, to = "stop", why = "the ball is there" },
    { when = function(_, m) return m.vars.sees end, to = "approach" },
  },
  k.state "approach" {
    enter = function(m) m.vars.armed, m.vars.kicked = false, false end,
    during = function(m, s)
      local b = look(m, s)
      m.vars.kicked = m.vars.armed and not walk.kicks(m)
      m.vars.armed = walk.kicks(m)
      if not m.vars.kicked then approach(m, b) end
    end,
    exit = walk.keep,
    { when = lies, to = "fallen", why = "lies" },
    { when = there, to = "stop", why = "the ball is there" },
    { when = function(_, m) return m.vars.kicked end, to = "watch" },
    { when = function(_, m) return not m.vars.sees end, to = "search", why = "lost" },
  },
  k.state "watch" {
    enter = function(m) walk.go(m, {}) end,
    during = look,
    { when = lies, to = "fallen", why = "lies" },
    { when = there, to = "stop", why = "the ball is there" },
    { after = P.watch_s, to = "search" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = lies, to = "failed", why = "lies" },
    { when = function(_, m) return m.vars.stands end, to = "done" },
  },
  k.state "fallen" {
    enter = walk.stop,
    k.call "get_up",
    { on = "done", to = "set_out" },
    { on = "failed", to = "failed" },
  },
  k.final "done" { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

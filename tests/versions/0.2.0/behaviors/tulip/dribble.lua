-- Dribbles the ball that it sees along a line, at walking speed: short kicks within its steps, and no stand between them.
local k = require "kadans"
local ball = require "ball"
local dribble = require "dribbling"
local floor = require "floor"
local walk = require "walking"

local P = k.params {
  settle_s  = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  rad       = { 0, min = -3.14, max = 3.14, unit = "rad", doc = "where the ball shall go, from how it sets out" },
  for_m     = { 1000, min = 0.1, max = 1000, unit = "m", doc = "how far, from where it is seen first" },
  most_m_s  = { 0.4, min = 0.1, max = 0.6, unit = "m/s", doc = "how fast it walks at most" },
  back_m    = { 1.5, min = 0.3, max = 10, unit = "m", doc = "the way over which the ball comes back to its line" },
  roll_m_s2 = { 0.28, min = 0.01, max = 5, unit = "m/s2", doc = "how the ground slows a ball" },
  lost_s    = { 2, min = 0.1, max = 20, unit = "s", doc = "a ball not seen for so long is looked for" },
}

local function look(m, s)
  local b = dribble.watch(m, s, m.vars.known, P.roll_m_s2)
  m.vars.sees = b ~= nil and s.time_s - b.seen_s < P.lost_s
  if not b then return nil end
  m.vars.line = m.vars.line or { x_m = b.x_m, y_m = b.y_m, rad = P.rad }
  m.vars.there = -ball.beside(b, m.vars.line, P.rad) > P.for_m
  return b
end

local function lies(s) return floor.lies(s.base) end
local function there(_, m) return m.vars.there end

return k.behavior "dribble" {
  controls = "walking",
  initial  = "set_out",
  vars     = { known = {}, kept = {}, line = false, side = 1, sees = false, there = false, stands = false },

  k.state "set_out" {
    run = function(m) walk.set_out(m, P.settle_s) end,
    { on = "run.done", to = "search" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "search" {
    enter = function(m) ball.search(m, m.vars.known) end,
    during = look,
    { when = lies, to = "fallen", why = "lies" },
    { when = there, to = "stop", why = "the ball is there" },
    { when = function(_, m) return m.vars.sees end, to = "dribble" },
  },
  k.state "dribble" {
    enter = function(m) dribble.begin(m, m.vars.kept) end,
    during = function(m, s) dribble.along(m, look(m, s), m.vars.line, P.most_m_s, P.back_m) end,
    exit = function(m) dribble.finish(m, m.vars.kept) end,
    { when = lies, to = "fallen", why = "lies" },
    { when = there, to = "stop", why = "the ball is there" },
    { when = function(_, m) return not m.vars.sees end, to = "search", why = "lost" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = lies, to = "fallen", why = "lies" },
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

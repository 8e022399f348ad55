-- Walks to a place, counted from where it sets out, and stands there.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s    = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  x_m         = { 1, min = -20, max = 20, unit = "m", doc = "the place, forward" },
  y_m         = { 0, min = -20, max = 20, unit = "m", doc = "to the left" },
  heading_rad = { 0, min = -3.14, max = 3.14, unit = "rad", doc = "the heading there" },
  most_m_s    = { 0.3, min = 0.05, max = 0.6, unit = "m/s", doc = "how fast it walks" },
}

return k.behavior "walk_to" {
  controls = "walking",
  initial  = "set_out",

  k.state "set_out" {
    enter = function(m)
      m.posture:move("set_out", { time_s = P.settle_s })
      walk.here(m, { x_m = 0, y_m = 0, heading_rad = 0 })
    end,
    { after = P.settle_s, to = "walk" },
  },
  k.state "walk" {
    during = function(m)
      m.vars.there = walk.to(m, { x_m = P.x_m, y_m = P.y_m, heading_rad = P.heading_rad }, nil, P.most_m_s)
    end,
    { when = function(_, m) return m.vars.there end, to = "stop" },
  },
  k.state "stop" {
    enter = walk.stop,
    during = function(m) m.vars.stands = walk.stands(m) end,
    { when = function(_, m) return m.vars.stands end, to = "there" },
  },
  k.final "there" { outcome = "done" },
}

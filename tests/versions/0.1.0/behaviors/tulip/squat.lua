-- Squats and stands up again, a few times. Change depth_m and run it again.
local k = require "kadans"
local legs = require "legs"

local P = k.params {
  depth_m   = { 0.10, min = 0, max = 0.20, unit = "m", doc = "how far the torso goes down" },
  down_s    = { 1.5, min = 0.5, max = 10, unit = "s", doc = "time to go down" },
  hold_s    = { 1.0, min = 0, max = 10, unit = "s", doc = "time to stay down" },
  up_s      = { 1.5, min = 0.5, max = 10, unit = "s", doc = "time to stand up" },
  rest_s    = { 1.0, min = 0, max = 10, unit = "s", doc = "time to stand between two squats" },
  settle_s  = { 1.5, min = 0.1, max = 10, unit = "s", doc = "time to come to rest at the start" },
  repeats   = { 3, min = 1, max = 100, doc = "how many squats" },
}

local thigh_m, shank_m = 0.275, 0.275
local stand = k.pose "stand"

-- Feet flat, torso upright, depth_m lower than standing.
local function crouch()
  return legs.lowered(stand, { "l_", "r_" }, thigh_m, shank_m, P.depth_m)
end

return k.behavior "squat" {
  controls = "posture",
  vars     = { done = 0 },
  initial  = "settle",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "settle" {
    enter = function(m)
      m.posture:set_gains("stiff")
      m.posture:move("stand", { time_s = P.settle_s })
    end,
    { after = P.settle_s, to = "squat" },
  },
  k.state "squat" {
    run = function(m)
      m.posture:move(crouch(), { time_s = P.down_s }):wait()
      m:wait(P.hold_s)
      m.posture:move("stand", { time_s = P.up_s }):wait()
      m.vars.done = m.vars.done + 1
    end,
    { on = "run.done", to = "rest" },
  },
  k.state "rest" {
    { when = function(_, m) return m.vars.done >= P.repeats end, after = P.rest_s, to = "done" },
    { after = P.rest_s, to = "squat" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}

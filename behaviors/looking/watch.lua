-- Looks at a point to the left and below, at one to the right and above, and says why it cannot look straight up, nor
-- turn as fast as an eye.
local k = require "kadans"

local P = k.params {
  time_s = { 0.8, min = 0.2, max = 10, unit = "s", doc = "time of each motion" },
  hold_s = { 0.7, min = 0, max = 10, unit = "s", doc = "time to look there" },
}

local function looks(m, point_m)
  m.body:move({ gaze_m = point_m }, { time_s = P.time_s })
  m:wait(P.time_s + P.hold_s)
end

return k.behavior "watch" {
  controls = "body",
  initial  = "settle",
  k.state "settle" { { after = 0.3, to = "left" } },
  k.state "left" {
    run = function(m) looks(m, { 1, 0.6, -0.1 }) end,
    { on = "run.done", to = "right" },
  },
  k.state "right" {
    run = function(m) looks(m, { 1, -0.5, 0.5 }) end,
    { on = "run.done", to = "refused" },
  },
  k.state "refused" {
    run = function(m)
      local _, why, by_rad = m.body:move({ gaze_m = { 0, 0, 2 } }, { time_s = P.time_s })
      k.log.info("straight up: %s by %.2f rad", why, by_rad)
      local _, too, _, words = m.body:move({ gaze_m = { 0.2, 1, 0 } }, { time_s = 0.05 })
      k.log.info("at once: %s, %s", too, words)
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}

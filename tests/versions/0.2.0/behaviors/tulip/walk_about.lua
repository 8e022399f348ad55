-- Walks with velocities that are drawn anew every few seconds, and comes to stand now and then. The sweep walk_any plays
-- it.
local k = require "kadans"
local walk = require "walking"

local P = k.params {
  settle_s = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  change_s = { 2, min = 0.1, max = 60, unit = "s", doc = "time until the next velocity" },
  stands   = { 0.1, min = 0, max = 1, doc = "share of the times in which it comes to stand" },
}

local function between(low, high) return low + (high - low) * math.random() end

local function draw()
  return { forward_m_s = between(-0.15, 0.4), left_m_s = between(-0.12, 0.12), turn_rad_s = between(-0.6, 0.6) }
end

return k.behavior "walk_about" {
  controls = "walking",
  initial  = "walk",

  k.state "walk" {
    endless = true,
    run = function(m)
      m.posture:move("set_out", { time_s = P.settle_s })
      m:wait(P.settle_s)
      while true do
        if math.random() < P.stands then
          walk.stop(m)
        else
          while not walk.go(m, draw()) do end
        end
        m:wait(P.change_s)
      end
    end,
  },
}

-- The joystick task of 2008: ten times a second the stick's x and y become the rates of pan and tilt. The stick is
-- played: it goes round, as a hand would lead it.
local k = require "kadans"

local P = k.params {
  rate_rad_s = { 1.5, min = 0, max = 5, unit = "rad/s", doc = "rate at the stick's end" },
  turn_s     = { 2.5, min = 0.5, max = 60, unit = "s", doc = "time in which the stick goes round" },
  lasts_s    = { 5, min = 0.1, max = 600, unit = "s", doc = "how long it is played" },
}

local period_s = 0.1

-- Where the stick is, -1..1.
local function stick(time_s)
  local angle = 2 * math.pi * time_s / P.turn_s
  return math.cos(angle), 0.5 * math.sin(angle)
end

return k.behavior "stick" {
  controls = "velocity",
  initial  = "played",

  k.state "played" {
    run = function(m)
      for i = 0, math.floor(P.lasts_s / period_s) do
        local x, y = stick(i * period_s)
        m.rate:set("pan.velocity_rad_s", P.rate_rad_s * x, { time_s = period_s })
        m.rate:set("tilt.velocity_rad_s", P.rate_rad_s * y, { time_s = period_s })
        m:wait(period_s)
      end
      m.rate:set("pan.velocity_rad_s", 0, { time_s = 0.2 })
      m.rate:set("tilt.velocity_rad_s", 0, { time_s = 0.2 }):wait()
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}

-- The joystick task of 2008: ten times a second the stick's x and y become the velocity of a target 1 m ahead. The stick is
-- played: it goes round, as a hand would lead it.
local k = require "kadans"

local P = k.params {
  velocity_m_s = { 0.4, min = 0, max = 3, unit = "m/s", doc = "of the target at the stick's end" },
  turn_s       = { 4, min = 0.5, max = 60, unit = "s", doc = "time in which the stick goes round" },
  lasts_s      = { 8, min = 0.1, max = 600, unit = "s", doc = "how long it is played" },
}

local period_s = 0.1

return k.behavior "stick" {
  controls = "gaze",
  initial  = "played",

  k.state "played" {
    run = function(m)
      for i = 0, math.floor(P.lasts_s / period_s) do
        local angle = 2 * math.pi * i * period_s / P.turn_s
        m.gaze:set("y_m_s", P.velocity_m_s * math.cos(angle))
        m.gaze:set("z_m_s", P.velocity_m_s * math.sin(angle))
        m:wait(period_s)
      end
      m.gaze:set("y_m_s", 0)
      m.gaze:set("z_m_s", 0)
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done" { outcome = "done" },
}

-- JIWIY follows a joystick. The first three buttons choose whether the stick means a pose, a rate or a path. With it
-- they choose the control set, also while the camera moves.
local k = require "kadans"

local function poses(s) return s.joystick.button_1 end
local function turns(s) return s.joystick.button_2 end
local function leads(s) return s.joystick.button_3 end

return k.behavior "stick" {
  initial = "velocity",
  always  = {
    { when = function(s) return s.safety.level ~= "normal" end, to = "failed", why = "safety" },
  },

  k.state "position" {
    k.call "stick_position" {},
    { when = turns, to = "velocity", why = "button 2" },
    { when = leads, to = "effort", why = "button 3" },
  },
  k.state "velocity" {
    k.call "stick_velocity" {},
    { when = poses, to = "position", why = "button 1" },
    { when = leads, to = "effort", why = "button 3" },
  },
  k.state "effort" {
    k.call "stick_effort" {},
    { when = poses, to = "position", why = "button 1" },
    { when = turns, to = "velocity", why = "button 2" },
  },
  k.final "failed" { outcome = "failed" },
}

-- The keeper throws itself to one side: it crouches on one leg, pushes off, and lies along the goal line. What comes after
-- that is get_up's.
--
-- The two poses were found by random search over balls that roll past at 0.25 to 1.2 m to the side, within the torque
-- and speed of the motors.
local k = require "kadans"
local poses = require "poses"

local P = k.params {
  left    = { 1, min = 0, max = 1, doc = "1: to the left, 0: to the right" },
  lie_s   = { 0.6, min = 0, max = 5, unit = "s", doc = "how long it stays as it fell" },
}

-- To the left: what it loads, and how it pushes off.
local load_s, push_s = 0.336, 0.41
local load = {
  l_hip_pitch = -1.323, l_knee = 0.442, l_hip_roll = 0.245, l_ankle_pitch = 0.156,
  r_hip_pitch = -0.099, r_knee = 0.786, r_hip_roll = -0.5, r_ankle_pitch = -0.64,
  l_shoulder_pitch = 3, r_shoulder_pitch = 3,
}
local push = {
  l_hip_pitch = -1.6, l_knee = 1.849, l_hip_roll = -0.102, l_ankle_pitch = 0,
  r_hip_pitch = -1.066, r_knee = 0.842, r_hip_roll = -0.5, r_ankle_pitch = 0,
}

local function to(side, pose) return side > 0.5 and pose or poses.mirrored(pose) end

return k.behavior "dive" {
  controls = "posture",
  initial  = "throw",

  k.state "throw" {
    run = function(m)
      m.posture:set_gains("stiff")
      m.posture:move(to(P.left, load), { time_s = load_s }):wait()
      m.posture:move(to(P.left, push), { time_s = push_s }):wait()
      m:wait(P.lie_s)
    end,
    { on = "run.done", to = "lies" },
  },
  k.final "lies" { outcome = "done" },
}

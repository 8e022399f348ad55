-- The keeper lets itself fall to one side, along the goal line, as fast as it can: the leg of that side goes up, the other
-- one pushes. What comes after that is get_up's.
--
-- The two poses were found by random search, on robots that differ, over balls that roll past 0.35 to 0.8 m to the side
-- 0.7 s later.
local k = require "kadans"
local poses = require "poses"

local P = k.params {
  left    = { 1, min = 0, max = 1, doc = "1: to the left, 0: to the right" },
  lie_s   = { 0.6, min = 0, max = 5, unit = "s", doc = "how long it stays as it fell" },
}

-- To the left: its left leg goes up, and the right one pushes it over.
local tuck_s, push_s = 0.1, 0.23
local tuck = {
  l_hip_pitch = -1.45, l_knee = 1.86, l_hip_roll = 0.37, l_ankle_pitch = 0.15,
  r_hip_pitch = -0.05, r_knee = 0.3, r_hip_roll = -0.14, r_ankle_pitch = 0.2,
  l_shoulder_pitch = 3, r_shoulder_pitch = 3,
}
local push = {
  l_hip_pitch = -1.38, l_knee = 2.17, l_hip_roll = 0, l_ankle_pitch = -0.31,
  r_hip_pitch = 0.5, r_knee = 0.09, r_hip_roll = -0.5, r_ankle_pitch = 0.13,
}

local function to(side, pose) return side > 0.5 and pose or poses.mirrored(pose) end

return k.behavior "dive" {
  controls = "posture",
  initial  = "throw",

  k.state "throw" {
    run = function(m)
      m.posture:set_gains("stiff")
      m.posture:move(to(P.left, tuck), { time_s = tuck_s }):wait()
      m.posture:move(to(P.left, push), { time_s = push_s }):wait()
      m:wait(P.lie_s)
    end,
    { on = "run.done", to = "lies" },
  },
  k.final "lies" { outcome = "done" },
}

-- How TULip moves on the floor: how to tell how it lies, and the key frames that roll it over and bring it up.
--
-- The way up needs little speed, and no momentum at its end. Lying on its face, the robot pulls its legs in until it is
-- folded on feet and head, with the thighs beside the waist. The arms, which came round over the back, lift the head.
-- The feet hop in until they are under the centre of mass. From there the torso rises with the centre of mass over the
-- soles all the way: the ankle angle of each point of `rise` was solved for that. From its back the robot first rolls
-- over one side: the leg of the other side pushes off.
--
-- Found within the URDF's limits by CMA-ES over random friction, gains, torque, masses, delay and noise.
local poses = require "poses"

local floor = {}

local lie = poses.both { l_hip_pitch = 0, l_knee = 0.1, l_ankle_pitch = -0.2, l_hip_roll = 0, l_hip_yaw = 0 }

-- Seconds, then both hips' pitch, knees, ankles' pitch, shoulders, in rad.
local fold = {
  { 0.63, -2.09, 1.55, -0.93, 1.81 },
  { 0.10, -2.05, 2.02, -0.68, 1.50 },
  { 0.31, -2.14, 0.73, -0.04, 3.46 },
  { 0.56, -2.36, 0.67, -0.77, 4.25 },
  { 0.38, -2.23, 0.12, 0.05, 4.15 },
}
local bear = { 0.40, -2.30, 0.25, 0.12, 4.35 }
local rise = {
  { 0.19, -2.031, 0.486, 0.066, 3.781 },
  { 0.19, -1.762, 0.687, -0.047, 3.212 },
  { 0.19, -1.494, 0.823, -0.176, 2.644 },
  { 0.19, -1.225, 0.875, -0.279, 2.075 },
  { 0.19, -0.956, 0.836, -0.332, 1.506 },
  { 0.19, -0.688, 0.712, -0.327, 0.937 },
  { 0.19, -0.419, 0.523, -0.274, 0.369 },
  { 0.19, -0.150, 0.300, -0.194, -0.200 },
}
-- Seconds, then of the left and of the right side: hip pitch, knee, hip roll, hip yaw, shoulder. Rolls over the left side.
-- The second way is for soft springs: legs that give way need quicker and wider strokes.
local rolls = {
  {
    { 0.43, { -0.48, 0.31, 0.42, -0.49, -4.00 }, { -0.76, 1.86, 0.10, 0.56, -0.06 } },
    { 0.31, { 0.10, 1.13, -0.16, -0.07, -3.77 }, { 0.46, 1.11, 0.43, 0.11, 2.74 } },
    { 0.26, { 0.14, 0.94, 0.35, -0.21, -3.38 }, { -1.23, 0.35, 0.15, 0.26, 1.40 } },
    { 0.24, { -0.08, 1.09, 0.27, -0.61, -4.00 }, { -0.99, 1.00, 0.02, 0.20, 0.20 } },
  },
  {
    { 0.29, { -0.42, 0.91, 0.29, -0.50, -4.60 }, { -0.52, 1.83, -0.13, 0.70, 0.36 } },
    { 0.21, { -0.21, 1.19, -0.14, -0.56, -4.60 }, { 0.47, 0.99, 0.50, -0.09, 3.41 } },
    { 0.30, { 0.23, 1.00, 0.32, -0.41, -2.07 }, { -0.78, 0.23, 0.04, 0.27, 2.24 } },
    { 0.18, { 0.09, 1.06, 0.29, -0.26, -3.42 }, { -0.76, 1.40, -0.03, 0.06, -0.41 } },
  },
}

local shoulder_max = 4.65  -- inside the limit of 4.7 rad
local turn = 2 * math.pi

-- Which way is up, in the base frame.
function floor.up(base)
  local flat = math.cos(base.pitch_rad)
  return { x = -math.sin(base.pitch_rad), y = flat * math.sin(base.roll_rad), z = flat * math.cos(base.roll_rad) }
end

-- Whether the torso lies, on whichever side.
function floor.lies(base) return base.posture ~= "upright" and base.posture ~= "falling" end

-- The whole turn to add to a shoulder's `target` so that it is nearest to where the arm is, within its limits.
function floor.nearest_turn(target, position)
  local best = 0
  for _, offset in ipairs { -turn, turn } do
    local inside = math.abs(target + offset) <= shoulder_max
    if inside and math.abs(target + offset - position) < math.abs(target + best - position) then best = offset end
  end
  return best
end

local function turned(pose, turns)
  for joint, offset in pairs(turns) do
    pose[joint] = math.max(-shoulder_max, math.min(shoulder_max, pose[joint] + offset))
  end
  return pose
end

-- The turns of both arms for a motion that begins with `pose`.
local function arms(pose, joints)
  local turns = {}
  for _, joint in ipairs { "l_shoulder_pitch", "r_shoulder_pitch" } do
    turns[joint] = floor.nearest_turn(pose[joint], joints[joint].position_rad)
  end
  return turns
end

local function even(frame)
  return poses.both {
    l_hip_yaw = 0, l_hip_roll = 0,
    l_hip_pitch = frame[2], l_knee = frame[3], l_ankle_pitch = frame[4], l_shoulder_pitch = frame[5],
  }
end

local function side(letter, v)
  return {
    [letter .. "_hip_pitch"] = v[1], [letter .. "_knee"] = v[2], [letter .. "_hip_roll"] = v[3],
    [letter .. "_hip_yaw"] = v[4], [letter .. "_shoulder_pitch"] = v[5], [letter .. "_ankle_pitch"] = -0.2,
  }
end

local function timed(pose, time_s) return { pose, time_s = time_s } end

-- Straight legs; the arms stay where they are.
function floor.lying() return poses.with(lie, {}) end

-- From the face onto hands and feet: { pose, time_s = }, one motion each, in `pace` times their time, and the turns of
-- the arms.
function floor.fold(joints, pace)
  local turns = arms(even(fold[1]), joints)
  local steps = {}
  for i, frame in ipairs(fold) do steps[i] = timed(turned(even(frame), turns), frame[1] * (pace or 1)) end
  return steps, turns
end

local function leaning(frame, lean)
  return even { frame[1], frame[2], frame[3], frame[4] + lean, frame[5] }
end

-- Weight over the feet, the hands just bear; `lean` rad further back in the ankles.
function floor.bear(turns, lean) return timed(turned(leaning(bear, lean), turns), bear[1]) end

-- From there to standing: points of one smooth curve, the last one without `lean`, in `pace` times its time. An arm that
-- came the other way round goes down in front.
function floor.rise(turns, lean, pace)
  local points = {}
  for i, frame in ipairs(rise) do
    local pose = leaning(frame, i < #rise and lean or 0)
    for joint, offset in pairs(turns) do
      local first, last = bear[5] + offset, rise[#rise][5]
      pose[joint] = first + (last - first) * i / #rise
    end
    points[i] = timed(pose, frame[1] * (pace or 1))
  end
  return points
end

-- From the back, or the side, onto the face, over the left or the right side, in the first or the second `way`.
function floor.roll(over, joints, way)
  local steps, turns = {}, nil
  for i, frame in ipairs(rolls[way or 1]) do
    local pose = poses.with(side("l", frame[2]), side("r", frame[3]))
    if over == "right" then pose = poses.mirrored(pose) end
    turns = turns or arms(pose, joints)
    steps[i] = timed(turned(pose, turns), frame[1])
  end
  return steps
end

return floor

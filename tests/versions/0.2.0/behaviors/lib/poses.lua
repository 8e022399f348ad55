-- Pose tables, joint name -> radians: mirroring between the left and the right side, merging, mixing.
local poses = {}

local other_side = { ["l_"] = "r_", ["r_"] = "l_" }

-- Joints that turn about x or z swing the other way on the other side: "hip_yaw", "hip_roll", "ankle_roll" ...
local function turns_over(joint)
  return joint:find("_yaw", 1, true) ~= nil or joint:find("_roll", 1, true) ~= nil
end

-- The pose with left and right exchanged; joints of neither side stay, but for the sign of yaw and roll.
function poses.mirrored(pose)
  local mirrored = {}
  for joint, position in pairs(pose) do
    local side = other_side[joint:sub(1, 2)]
    local name = side and side .. joint:sub(3) or joint
    mirrored[name] = turns_over(joint) and -position or position
  end
  return mirrored
end

-- One side's joints given for both: { l_knee = 1 } becomes { l_knee = 1, r_knee = 1 }.
function poses.both(pose)
  local all = poses.mirrored(pose)
  for joint, position in pairs(pose) do all[joint] = position end
  return all
end

-- `change` laid over `pose`; neither is altered.
function poses.with(pose, change)
  local merged = {}
  for joint, position in pairs(pose) do merged[joint] = position end
  for joint, position in pairs(change) do merged[joint] = position end
  return merged
end

-- The pose between two, share 0 .. 1 of the way from `a` to `b`. Joints that only one of them names are left out.
function poses.between(a, b, share)
  local mixed = {}
  for joint, position in pairs(a) do
    if b[joint] ~= nil then mixed[joint] = position + share * (b[joint] - position) end
  end
  return mixed
end

return poses

-- Leg postures by inverse kinematics, for legs that bend in one plane: hip pitch, knee, ankle pitch. Positive angles
-- turn about y: a bent knee is positive, and a hip that lifts the thigh forward is negative.
local legs = {}

-- The angles that put the ankle `distance_m` straight below the hip, the foot parallel to the torso.
-- Raises when the leg cannot do that.
function legs.bend(thigh_m, shank_m, distance_m)
  local reach_m = thigh_m + shank_m
  if not (distance_m > math.abs(thigh_m - shank_m) and distance_m <= reach_m) then
    error(string.format("a leg of %.3f m cannot put its ankle %.3f m below the hip", reach_m, distance_m), 2)
  end
  local cosine = (distance_m ^ 2 - thigh_m ^ 2 - shank_m ^ 2) / (2 * thigh_m * shank_m)
  local knee = math.acos(math.max(-1, math.min(1, cosine)))
  local hip = -math.atan2(shank_m * math.sin(knee), thigh_m + shank_m * math.cos(knee))
  return { hip_pitch = hip, knee = knee, ankle_pitch = -(hip + knee) }
end

-- From hip to ankle with this knee.
function legs.distance(thigh_m, shank_m, knee)
  return math.sqrt(thigh_m ^ 2 + shank_m ^ 2 + 2 * thigh_m * shank_m * math.cos(knee))
end

-- The leg joints of `pose`, lower by depth_m: "l_hip_pitch" ... for the legs named in `sides` ("l_", "r_").
function legs.lowered(pose, sides, thigh_m, shank_m, depth_m)
  local lowered = {}
  for _, side in ipairs(sides) do
    local now_m = legs.distance(thigh_m, shank_m, pose[side .. "knee"])
    local before = legs.bend(thigh_m, shank_m, now_m)
    local after = legs.bend(thigh_m, shank_m, now_m - depth_m)
    for part, position in pairs(after) do
      lowered[side .. part] = pose[side .. part] + position - before[part]
    end
  end
  return lowered
end

return legs

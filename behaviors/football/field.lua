-- Where things are on the field, in the team's frame: origin at the centre, x toward the goal that the team attacks,
-- y to the left. The robot knows its own place from the entry `field` of its world model.
local field = {}

local function angle(rad) return math.atan2(math.sin(rad), math.cos(rad)) end
local function within(value, least, most) return math.max(least, math.min(most, value)) end
field.angle, field.within = angle, within

function field.distance(a, b) return math.sqrt((a.x_m - b.x_m) ^ 2 + (a.y_m - b.y_m) ^ 2) end

-- The robot's own pose, and whether it trusts it; nil before it was ever told.
function field.pose(s)
  local centre = s.seen.field
  if not (centre.confidence > 0) then return nil end
  local heading_rad = -centre.heading_rad
  local c, n = math.cos(heading_rad), math.sin(heading_rad)
  return {
    x_m = -(c * centre.x_m - n * centre.y_m),
    y_m = -(n * centre.x_m + c * centre.y_m),
    heading_rad = angle(heading_rad),
    known = centre.known > 0.5,
  }
end

-- What is seen from the robot at (x_m, y_m), on the field; and back.
function field.from_robot(pose, x_m, y_m)
  local c, n = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
  return { x_m = pose.x_m + c * x_m - n * y_m, y_m = pose.y_m + n * x_m + c * y_m }
end
function field.to_robot(pose, place)
  local c, n = math.cos(pose.heading_rad), math.sin(pose.heading_rad)
  local x_m, y_m = place.x_m - pose.x_m, place.y_m - pose.y_m
  return { x_m = c * x_m + n * y_m, y_m = c * y_m - n * x_m }
end

-- The robots that are seen, on the field: { x_m =, y_m =, mate = true or false }.
function field.robots(s, pose)
  local all = {}
  for _, seen in ipairs { s.seen.robot_1, s.seen.robot_2, s.seen.robot_3 } do
    if seen.confidence > 0 and seen.age_s < 1 then
      local at = field.from_robot(pose, seen.x_m, seen.y_m)
      at.mate = seen.mate > 0.5
      all[#all + 1] = at
    end
  end
  return all
end

-- A place on the way to `goal` that leaves robots in the way to one side.
function field.around(pose, goal, robots)
  local x_m, y_m = goal.x_m - pose.x_m, goal.y_m - pose.y_m
  local far_m = math.sqrt(x_m ^ 2 + y_m ^ 2)
  if far_m < 0.3 then return goal end
  local ux, uy = x_m / far_m, y_m / far_m
  for _, robot in ipairs(robots) do
    local ahead_m = ux * (robot.x_m - pose.x_m) + uy * (robot.y_m - pose.y_m)
    local left_m = ux * (robot.y_m - pose.y_m) - uy * (robot.x_m - pose.x_m)
    if ahead_m > 0 and ahead_m < math.min(far_m, 1.2) and math.abs(left_m) < 0.6 then
      local side = left_m > 0 and -0.75 or 0.75
      return { x_m = robot.x_m - side * uy, y_m = robot.y_m + side * ux }
    end
  end
  return goal
end

return field

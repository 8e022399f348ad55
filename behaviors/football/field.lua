-- Where things are on the field, in the team's frame: origin at the centre, x toward the goal that the team attacks,
-- y to the left. The robot knows its own place from the entry `field` of its world model.
local walk = require "walking"

local field = { angle = walk.angle, distance = walk.distance }

function field.within(value, least, most) return math.max(least, math.min(most, value)) end

-- The robot's own pose, and whether it trusts it; nil before it was ever told.
function field.pose(s)
  local centre = s.seen.field
  if not (centre.confidence > 0) then return nil end
  local heading_rad = -centre.heading_rad
  local c, n = math.cos(heading_rad), math.sin(heading_rad)
  return {
    x_m = -(c * centre.x_m - n * centre.y_m),
    y_m = -(n * centre.x_m + c * centre.y_m),
    heading_rad = walk.angle(heading_rad),
    known = centre.known > 0.5,
  }
end

-- What is seen from the robot at (x_m, y_m), on the field; and back.
function field.from_robot(pose, x_m, y_m)
  local at_x_m, at_y_m = walk.seen_from(pose, x_m, y_m)
  return { x_m = at_x_m, y_m = at_y_m }
end
function field.to_robot(pose, place)
  local x_m, y_m = walk.as_seen(pose, place)
  return { x_m = x_m, y_m = y_m }
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

-- The place beside a goal's post that is in the way from the robot to `goal`, on the field's side of it, or nil. It goes
-- on around the post as the robot comes nearer; a fixed place before the post was left by none whose way passed it again.
local post_m, beside_post_m = 0.4, 0.55
function field.past_posts(me, pose, goal)
  local x_m, y_m = goal.x_m - pose.x_m, goal.y_m - pose.y_m
  local far_m = math.max(math.sqrt(x_m ^ 2 + y_m ^ 2), 0.01)
  local ux, uy = x_m / far_m, y_m / far_m
  for _, end_m in ipairs { -me.length_m / 2, me.length_m / 2 } do
    for _, side_m in ipairs { -me.goal_m / 2 - 0.05, me.goal_m / 2 + 0.05 } do
      local px_m, py_m = end_m - pose.x_m, side_m - pose.y_m
      local ahead_m = ux * px_m + uy * py_m
      local left_m = ux * py_m - uy * px_m  -- of the way
      if ahead_m > 0 and ahead_m < far_m and math.abs(left_m) < post_m then
        local to_left = left_m < 0
        if math.abs(uy) > 0.2 then to_left = uy * end_m > 0 end
        local aside_m = to_left and beside_post_m or -beside_post_m
        return { x_m = end_m - aside_m * uy, y_m = side_m + aside_m * ux }
      end
    end
  end
  return nil
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

-- A place on the way to `goal` that comes no nearer than keep_m to `centre`: away from it first, then around it.
function field.clear_of(pose, goal, centre, keep_m)
  local x_m, y_m = pose.x_m - centre.x_m, pose.y_m - centre.y_m
  local far_m = math.max(math.sqrt(x_m ^ 2 + y_m ^ 2), 0.01)
  local function at(rad, m) return { x_m = centre.x_m + m * math.cos(rad), y_m = centre.y_m + m * math.sin(rad) } end
  local from_rad = math.atan2(y_m, x_m)
  if far_m < keep_m then return at(from_rad, keep_m + 0.3) end
  local gx_m, gy_m = goal.x_m - pose.x_m, goal.y_m - pose.y_m
  local way_m = math.max(math.sqrt(gx_m ^ 2 + gy_m ^ 2), 0.01)
  local ahead_m = -(x_m * gx_m + y_m * gy_m) / way_m  -- to where the straight way is nearest to the centre
  local beside_m = math.abs(gx_m * y_m - gy_m * x_m) / way_m
  if ahead_m <= 0 or ahead_m > way_m or beside_m >= keep_m then return goal end
  local turn_rad = field.angle(math.atan2(goal.y_m - centre.y_m, goal.x_m - centre.x_m) - from_rad)
  return at(from_rad + field.within(turn_rad, -0.8, 0.8), keep_m + 0.3)
end

return field

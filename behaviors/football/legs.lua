-- What a play asks of the legs: orders to the behavior `footwork`, which plays all the time.
local field = require "field"

local legs = {}

local to = { to = "footwork" }

-- To a place of the field, to face `toward` there; other robots are walked around.
function legs.go(m, s, pose, place, toward, most_m_s)
  local near = field.around(pose, place, field.robots(s, pose))
  local at = field.to_robot(pose, near)
  local heading_rad = math.atan2(toward.y_m - place.y_m, toward.x_m - place.x_m)
  m:emit("foot.go", { x_m = at.x_m, y_m = at.y_m, heading_rad = field.angle(heading_rad - pose.heading_rad), most_m_s = most_m_s }, to)
end

-- The ball to a place of the field, so that it would roll beyond_m farther.
function legs.kick(m, pose, place, beyond_m)
  local at = field.to_robot(pose, place)
  m:emit("foot.kick", { x_m = at.x_m, y_m = at.y_m, beyond_m = beyond_m }, to)
end

function legs.turn(m, rad_s) m:emit("foot.turn", { rad_s = rad_s }, to) end
function legs.stand(m) m:emit("foot.stand", {}, to) end

return legs

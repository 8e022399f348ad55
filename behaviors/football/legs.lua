-- What a play asks of the legs: orders to the behavior `footwork`, which plays all the time.
local field = require "field"

local legs = {}

local far_m, behind_rad, turns_rad_s = 0.5, 1.1, 0.7
local glances_s, glance_rad = 7, 0.3

local again_s = 0.2  -- the same order is sent again after that, with its place as it is seen by then

-- footwork is played again when an error ended it.
local function order(m, s, name, data)
  local sent = m.vars.sent
  if not m:plays("footwork") then
    if not sent or sent.name ~= "" or s.time_s - sent.at_s > 1 then
      m:replace("footwork")
      m.vars.sent = { name = "", at_s = s.time_s }
    end
    return
  end
  if sent and sent.name == name and s.time_s - sent.at_s < again_s - 1e-6 then return end
  m.vars.sent = { name = name, at_s = s.time_s }
  m:emit(name, data, { to = "footwork" })
end

-- To a place of the field, to face `toward` there; other robots are walked around. What is behind it, it turns to first,
-- on the spot, which is quicker than while it walks.
function legs.go(m, s, pose, place, toward, most_m_s)
  local near = field.past_posts(s.seen.me, pose, place) or field.around(pose, place, field.robots(s, pose))
  local at = field.to_robot(pose, near)
  local heading_rad = field.angle(math.atan2(toward.y_m - place.y_m, toward.x_m - place.x_m) - pose.heading_rad)
  local turn_rad = field.distance(pose, near) > far_m and math.atan2(at.y_m, at.x_m) or heading_rad
  if math.abs(turn_rad) > behind_rad then return legs.turn(m, s, turn_rad > 0 and turns_rad_s or -turns_rad_s) end
  order(m, s, "foot.go", { x_m = at.x_m, y_m = at.y_m, heading_rad = heading_rad, most_m_s = most_m_s })
end

-- The same for one that waits there: it looks to both sides of the ball in turn, for robots and lines.
function legs.watch(m, s, pose, place, ball)
  local x_m, y_m = ball.x_m - place.x_m, ball.y_m - place.y_m
  local rad = math.floor(s.time_s / glances_s) % 2 == 0 and glance_rad or -glance_rad
  local c, n = math.cos(rad), math.sin(rad)
  legs.go(m, s, pose, place, { x_m = place.x_m + c * x_m - n * y_m, y_m = place.y_m + n * x_m + c * y_m })
end

-- Whether it lies, or gets up.
function legs.lies(m)
  local state = m:plays("footwork")
  return state ~= nil and (state:find("fallen", 1, true) or state:find("dive", 1, true)) ~= nil
end

-- The same, no nearer to the ball than the rules want of a team that does not kick. It may take them 45 s to do it:
-- meanwhile it looks around.
function legs.keep_away(m, s, pose, place, ball)
  local way = field.clear_of(pose, place, ball, s.seen.me.circle_m + 0.35)
  legs.watch(m, s, pose, way, ball)
end

-- The ball to a place of the field, so that it would roll beyond_m farther.
function legs.kick(m, s, pose, place, beyond_m)
  local at = field.to_robot(pose, place)
  order(m, s, "foot.kick", { x_m = at.x_m, y_m = at.y_m, beyond_m = beyond_m })
end

-- The keeper throws itself to "left" or "right"; then it gets up.
function legs.dive(m, s, side) order(m, s, "foot.dive", { left = side == "left" and 1 or 0 }) end

function legs.turn(m, s, rad_s) order(m, s, "foot.turn", { rad_s = rad_s }) end
function legs.stand(m, s) order(m, s, "foot.stand", {}) end

return legs

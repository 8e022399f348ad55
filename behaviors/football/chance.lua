-- What a kick is worth, by the chance of what may come of it. Kicks scatter. So each kick is looked at nine times, as
-- kicks scatter: where does the ball come to rest, and what is it worth to the team there? A goal is worth 1, one of the
-- others -1. Shooting, passing, dribbling and clearing the ball are all judged by this.
local field = require "field"

local chance = {}

local scatter_rad, scatter_far = 0.1, 0.2  -- standard deviations of a kick's direction, and of its distance as a share
local far_m, near_m = 4, 0.3               -- the hardest and the softest kick
local body_m = 0.35                        -- a robot stops a ball that passes nearer to its middle
local calm_m = 0.6                         -- who is nearer to the ball by so much, has it in two cases of three
local best = 0.8                           -- what a ball before an open goal is worth

-- Nine equally likely deviations of a direction, each with one of the distance.
local kicks = {}
do
  local parts = { -1.59, -0.97, -0.59, -0.28, 0, 0.28, 0.59, 0.97, 1.59 }
  local order = { 5, 8, 2, 6, 9, 4, 1, 7, 3 }
  for i, part in ipairs(parts) do kicks[i] = { rad = scatter_rad * part, far = 1 + scatter_far * parts[order[i]] } end
end

-- What a place is worth to a team that has the ball there: how far ahead it is, and how wide the goal is open to it.
function chance.of_place(me, x_m, y_m)
  local half_m, post_m = me.length_m / 2, me.goal_m / 2
  local ahead = (x_m / half_m + 1) / 2
  local before_m = math.max(half_m - x_m, 0.05)
  local open_rad = math.atan2(y_m + post_m, before_m) - math.atan2(y_m - post_m, before_m)
  return best * (0.3 * ahead + 0.7 * math.min(open_rad / 1.2, 1))
end

local function nearest_m(robots, mates, x_m, y_m)
  local least_m = 10
  for _, robot in ipairs(robots) do
    if robot.mate == mates and not robot.leaves_ball then
      least_m = math.min(least_m, math.sqrt((robot.x_m - x_m) ^ 2 + (robot.y_m - y_m) ^ 2))
    end
  end
  return least_m
end

-- What a ball is worth that lies there, by who is nearer to it.
function chance.of_ball(me, robots, x_m, y_m)
  local lead_m = nearest_m(robots, false, x_m, y_m) - nearest_m(robots, true, x_m, y_m)
  local ours = 1 / (1 + math.exp(-lead_m / calm_m))
  return ours * chance.of_place(me, x_m, y_m) - (1 - ours) * chance.of_place(me, -x_m, -y_m)
end

-- How far it rolls until a robot, other than the one that kicks, is in its way; far itself when none is.
local function until_stopped(robots, ball, c, n, far)
  for _, robot in ipairs(robots) do
    local x_m, y_m = robot.x_m - ball.x_m, robot.y_m - ball.y_m
    local along_m = c * x_m + n * y_m
    if not robot.kicks and along_m > 0.2 and along_m < far and math.abs(c * y_m - n * x_m) < body_m then far = along_m end
  end
  return far
end

-- What one kick comes to, without scatter. `indirect`: no goal counts straight from it.
local function outcome(me, robots, ball, rad, far, indirect)
  local c, n = math.cos(rad), math.sin(rad)
  far = until_stopped(robots, ball, c, n, far)
  local half_m, side_m = me.length_m / 2, me.width_m / 2
  local to_end_m = math.abs(c) > 1e-6 and ((c > 0 and half_m or -half_m) - ball.x_m) / c or 100
  local to_side_m = math.abs(n) > 1e-6 and ((n > 0 and side_m or -side_m) - ball.y_m) / n or 100
  if to_end_m < far and to_end_m <= to_side_m then
    local in_goal = math.abs(ball.y_m + n * to_end_m) < me.goal_m / 2 - 0.1
    if c < 0 then return in_goal and -1 or -0.3 end  -- or a corner for the others
    return in_goal and not indirect and 1 or 0
  end
  local out = to_side_m < far
  if out then far = to_side_m end
  local x_m, y_m = ball.x_m + far * c, ball.y_m + far * n
  if out then return -chance.of_place(me, -x_m, -y_m) end  -- a throw-in for the others
  return chance.of_ball(me, robots, x_m, y_m)
end

-- The worth of a kick from `ball` to `place`, beyond_m farther. robots: { x_m =, y_m =, mate =, kicks =, leaves_ball = },
-- the robot that kicks among them, which may have to leave the ball to others then.
function chance.of_kick(me, robots, ball, place, beyond_m, indirect)
  local x_m, y_m = place.x_m - ball.x_m, place.y_m - ball.y_m
  local rad = math.atan2(y_m, x_m)
  local far = field.within(math.sqrt(x_m ^ 2 + y_m ^ 2) + beyond_m, near_m, far_m)
  local sum = 0
  for _, kick in ipairs(kicks) do sum = sum + outcome(me, robots, ball, rad + kick.rad, far * kick.far, indirect) end
  return sum / #kicks
end

return chance

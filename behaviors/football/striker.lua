-- The striker: goes to the ball and kicks it at the goal, or out of the circle at a kick-off.
local field = require "field"
local game = require "game"
local legs = require "legs"
local search = require "search"

local striker = {}

-- At the corner of the goal that is farther from the robots before it; the middle when nobody is there.
local function aim(s, pose, ball)
  local goal = game.goal(s)
  local reach_m = s.seen.me.goal_m / 2 - 0.5
  for _, robot in ipairs(field.robots(s, pose)) do
    if robot.x_m > ball.x_m + 0.3 and field.distance(robot, goal) < 2.5 then
      return { x_m = goal.x_m, y_m = robot.y_m > 0 and -reach_m or reach_m }
    end
  end
  return goal
end

-- No goal counts straight from a kick-off: the ball goes out of the circle first, aslant.
local function kick_off_place(s)
  local far_m = s.seen.me.circle_m + 0.35
  return { x_m = far_m * 0.95, y_m = 0.3 * far_m }
end

function striker.play(m, s, pose, ball)
  if game.penalty_kick(s) and s.seen.game.ours ~= 1 then return legs.stand(m, s) end
  if not ball then return search.play(m, s, pose) end
  if not ball.own then return legs.go(m, s, pose, ball, ball) end
  local in_circle = field.distance(ball, { x_m = 0, y_m = 0 }) < s.seen.me.circle_m + 0.1
  if m.vars.kick_off_ours and in_circle then return legs.kick(m, s, pose, kick_off_place(s), 0) end
  m.vars.kick_off_ours = m.vars.kick_off_ours and in_circle
  if game.keeps_away(s) or m.vars.kick_off_theirs then return striker.block(m, s, pose, ball) end
  legs.kick(m, s, pose, aim(s, pose, ball), 1.2)
end

-- Between the ball and the own goal, as far from the ball as the rules want.
function striker.block(m, s, pose, ball)
  local own = game.own_goal(s)
  local far_m = math.max(field.distance(ball, own), 0.1)
  local keep_m = math.min(s.seen.me.circle_m + 0.6, far_m)
  local share = keep_m / far_m
  legs.go(m, s, pose, { x_m = ball.x_m + share * (own.x_m - ball.x_m), y_m = ball.y_m + share * (own.y_m - ball.y_m) }, ball)
end

return striker

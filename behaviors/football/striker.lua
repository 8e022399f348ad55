-- The striker: goes to the ball and does with it what has the best chance; at a kick-off the ball goes out of the circle.
local field = require "field"
local game = require "game"
local kicks = require "kicks"
local legs = require "legs"
local search = require "search"

local striker = {}

local unseen_m, back_m = 0.6, 0.45
local carpet_m = 0.7  -- so far beside the field it turns back; the carpet ends after 1 m

-- No goal counts straight from a kick-off: the ball goes out of the circle first, aslant.
local function kick_off_place(s)
  local far_m = s.seen.me.circle_m + 0.35
  return { x_m = far_m * 0.95, y_m = 0.3 * far_m }
end

-- A robot, or two, in the way to a ball that is far: around them first.
local function goes_around(m, s, pose, ball)
  if field.distance(pose, ball) < 1 or field.around(pose, ball, field.robots(s, pose)) == ball then return false end
  legs.go(m, s, pose, ball, game.goal(s))
  return true
end

-- A post between it and the ball: footwork knows of none.
local function passes_post(m, s, pose, ball)
  local place = field.past_posts(s.seen.me, pose, ball)
  if not place then return false end
  legs.go(m, s, pose, place, ball)
  return true
end

-- A ball that rolls on is met where it comes to rest, from behind.
local function follows(m, s, pose, ball)
  if not ball.rolls or ball.rolls.m_s < 0.5 or field.distance(ball, ball.rest) < 0.5 then return false end
  local half_m, side_m = s.seen.me.length_m / 2, s.seen.me.width_m / 2
  local rest = { x_m = field.within(ball.rest.x_m, -half_m, half_m), y_m = field.within(ball.rest.y_m, -side_m, side_m) }
  if field.distance(pose, rest) < 1 then return false end
  legs.go(m, s, pose, { x_m = rest.x_m - 0.5, y_m = rest.y_m }, rest)
  return true
end

-- Beside the field it does not go on until it is off the carpet.
local function comes_back(m, s, pose, ball)
  local half_m, side_m = s.seen.me.length_m / 2, s.seen.me.width_m / 2
  if math.max(math.abs(pose.x_m) - half_m, math.abs(pose.y_m) - side_m) < carpet_m then return false end
  legs.go(m, s, pose, { x_m = field.within(pose.x_m, 0.5 - half_m, half_m - 0.5), y_m = field.within(pose.y_m, 0.5 - side_m, side_m - 0.5) }, ball)
  return true
end

-- To a ball that only a mate sees. One that lies before its feet, below what it sees itself, it steps back from until it
-- sees it.
local function comes_to(m, s, pose, ball)
  local far_m = field.distance(pose, ball)
  if far_m > unseen_m then return legs.go(m, s, pose, ball, game.goal(s)) end
  local rad = far_m > 0.05 and math.atan2(ball.y_m - pose.y_m, ball.x_m - pose.x_m) or pose.heading_rad
  local ahead = { x_m = pose.x_m + math.cos(rad), y_m = pose.y_m + math.sin(rad) }
  legs.go(m, s, pose, { x_m = pose.x_m - back_m * math.cos(rad), y_m = pose.y_m - back_m * math.sin(rad) }, ahead)
end

function striker.play(m, s, pose, ball)
  if game.penalty_kick(s) and s.seen.game.ours ~= 1 then return legs.stand(m, s) end
  if not ball then return search.play(m, s, pose) end
  if not ball.own then return comes_to(m, s, pose, ball) end
  local in_circle = field.distance(ball, { x_m = 0, y_m = 0 }) < s.seen.me.circle_m + 0.1
  if m.vars.kick_off_ours and in_circle then return legs.kick(m, s, pose, kick_off_place(s), 0) end
  m.vars.kick_off_ours = m.vars.kick_off_ours and in_circle
  if game.keeps_away(s) or m.vars.kick_off_theirs then return striker.block(m, s, pose, ball) end
  if comes_back(m, s, pose, ball) or passes_post(m, s, pose, ball) or follows(m, s, pose, ball) or goes_around(m, s, pose, ball) then return end
  local kick = kicks.choose(m, s, pose, ball)
  legs.kick(m, s, pose, kick, kick.beyond_m)
end

-- Between the ball and the own goal, as far from the ball as the rules want; at a goal kick out of the penalty area.
function striker.block(m, s, pose, ball)
  local own, me = game.own_goal(s), s.seen.me
  local far_m = math.max(field.distance(ball, own), 0.1)
  local keep_m = math.min(me.circle_m + 0.6, far_m)
  local share = keep_m / far_m
  local place = { x_m = ball.x_m + share * (own.x_m - ball.x_m), y_m = ball.y_m + share * (own.y_m - ball.y_m) }
  if game.their_goal_kick(s) then place.x_m = math.min(place.x_m, me.length_m / 2 - me.mark_m - 1.5) end
  legs.keep_away(m, s, pose, place, ball)
end

return striker

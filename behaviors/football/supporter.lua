-- The supporter: a mate is nearer to the ball. Going forward it offers itself ahead, on the other side, where a pass or a
-- ball that the keeper lets go comes by. When the others have the ball, or it is in the own half, it stands between the
-- ball and the own goal: beside the keeper's line, and on it when there is no keeper.
local field = require "field"
local game = require "game"
local legs = require "legs"
local search = require "search"

local supporter = {}

local ahead_m, before_goal_m, side_m = 1.5, 1.3, 1
local behind_ball_m = 1.6  -- with a keeper behind it
local covers_m = 0.9       -- without one: so near to the ball it hides most of the goal
local leaves_m = 0.6  -- so far it keeps from a ball that it must not touch
local near_m = 0.4  -- near enough to its place
local has_m = 2     -- an opponent that is farther from the ball does not have it,
local clear_m = 0.5 -- nor one that is nearer than a mate by less: they fight for it

local function ahead(me, pose, ball)
  local side = math.abs(ball.y_m) > 0.4 and (ball.y_m > 0 and -1 or 1) or (pose.y_m < ball.y_m and -1 or 1)
  local x_m = field.within(ball.x_m + ahead_m, -1, me.length_m / 2 - before_goal_m)
  return { x_m = x_m, y_m = ball.y_m + side * side_m - field.within(0.4 * ball.y_m, -0.6, 0.6) }
end

local function behind(me, s, ball)
  local side = ball.y_m > 0 and -1 or 1
  local behind_m = game.keeps_away(s) and me.circle_m + 1 or me.keeper > 0 and behind_ball_m or covers_m
  if me.keeper > 0 then return { x_m = ball.x_m - behind_m, y_m = ball.y_m + 0.8 * side } end
  local own = game.own_goal(s)
  local share = math.min(1, behind_m / math.max(field.distance(ball, own), 0.1))
  return { x_m = ball.x_m + share * (own.x_m - ball.x_m), y_m = ball.y_m + share * (own.y_m - ball.y_m) }
end

-- An opponent is clearly nearer to the ball than all mates.
function supporter.lost(m, s, ball)
  local their_m, our_m = has_m, 10
  for _, robot in ipairs(m.vars.others) do their_m = math.min(their_m, field.distance(robot, ball)) end
  for _, mate in pairs(m.vars.mates) do
    if s.time_s - mate.heard_s < 3 then our_m = math.min(our_m, field.distance(mate, ball)) end
  end
  return their_m < has_m and their_m + clear_m < our_m
end

function supporter.place(m, s, pose, ball)
  local me = s.seen.me
  local from_m = me.keeper > 0 and -0.2 * me.length_m or 0  -- without a keeper it covers the goal in all of its own half
  local attacks = ball.x_m > from_m and not game.keeps_away(s) and not supporter.lost(m, s, ball)
  local place = attacks and ahead(me, pose, ball) or behind(me, s, ball)
  local half_m, half_side_m = me.length_m / 2, me.width_m / 2
  local most_m = game.their_goal_kick(s) and half_m - me.mark_m - 1.5 or half_m - 0.8
  place.x_m = field.within(place.x_m, 0.8 - half_m, most_m)
  place.y_m = field.within(place.y_m, 0.5 - half_side_m, half_side_m - 0.5)
  return place
end

-- A mate is about to pass to it.
local function is_passed_to(m, s)
  for _, mate in pairs(m.vars.mates) do
    if mate.pass_to == s.seen.me.number and s.time_s - mate.heard_s < 2 then return true end
  end
  return false
end

function supporter.play(m, s, pose, ball)
  if game.penalty_kick(s) or not m.vars.can.support then return legs.stand(m, s) end
  if not ball then return search.play(m, s, pose) end
  local place = supporter.place(m, s, pose, ball)
  if game.keeps_away(s) then return legs.keep_away(m, s, pose, place, ball) end
  if field.distance(pose, place) < near_m or is_passed_to(m, s) then place = { x_m = pose.x_m, y_m = pose.y_m } end
  if m.vars.leaves_ball then return legs.go(m, s, pose, field.clear_of(pose, place, ball, leaves_m), ball) end
  if is_passed_to(m, s) then return legs.go(m, s, pose, place, ball) end
  legs.watch(m, s, pose, place, ball)
end

return supporter

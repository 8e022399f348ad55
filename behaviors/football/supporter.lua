-- The supporter: a mate has the ball. Going forward it offers itself ahead, on the other side, where a pass or a ball
-- that the keeper lets go comes by; otherwise it stands behind the ball, between it and the own goal.
local field = require "field"
local game = require "game"
local legs = require "legs"
local search = require "search"

local supporter = {}

local ahead_m, before_goal_m, side_m = 1.5, 1.3, 1
local near_m = 0.4  -- near enough to its place

local function ahead(me, pose, ball)
  local side = math.abs(ball.y_m) > 0.4 and (ball.y_m > 0 and -1 or 1) or (pose.y_m < ball.y_m and -1 or 1)
  local x_m = field.within(ball.x_m + ahead_m, -1, me.length_m / 2 - before_goal_m)
  return { x_m = x_m, y_m = ball.y_m + side * side_m - field.within(0.4 * ball.y_m, -0.6, 0.6) }
end

local function behind(me, s, ball)
  local side = ball.y_m > 0 and -1 or 1
  local behind_m = game.keeps_away(s) and me.circle_m + 1 or 1.6
  return { x_m = ball.x_m - behind_m, y_m = ball.y_m + 0.8 * side }
end

function supporter.place(s, pose, ball)
  local me = s.seen.me
  local attacks = ball.x_m > -0.2 * me.length_m and not game.keeps_away(s)
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
  local place = supporter.place(s, pose, ball)
  if game.keeps_away(s) then return legs.keep_away(m, s, pose, place, ball) end
  if field.distance(pose, place) < near_m or is_passed_to(m, s) then place = { x_m = pose.x_m, y_m = pose.y_m } end
  if is_passed_to(m, s) then return legs.go(m, s, pose, place, ball) end
  legs.watch(m, s, pose, place, ball)
end

return supporter

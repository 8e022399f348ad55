-- Which kick: at the goal, to a mate, or a short one ahead, to go on from there. All are judged alike (chance.lua), and the
-- best one is kept until another one is clearly better.
local chance = require "chance"
local field = require "field"
local game = require "game"

local kicks = {}

local again_s = 0.3                   -- how often it thinks again
local stale_s, moved_m = 1.5, 0.4     -- what it chose before that, or for a ball that lay elsewhere, is past
local better, better_near = 0.08, 0.2  -- by how much another kick must be better; with the ball before its feet
local before_feet_m = 0.9
local turns = 0.06                    -- what a radian of the way around the ball costs; more when somebody presses,
local presses_m, pressed = 1.5, 0.1
local hurries_s, hurry = 5, 0.05      -- and by so much a second more when the ball rests long: 10 s is a stuck game
local aside_rad = 0.25                -- so much of it costs nothing: who stands behind the ball need not choose again
local stands_m, beside = 0.5, 0.4      -- it stands so far behind the ball; what a metre outside of the field costs there
local dribble_m, pass_ahead_m = 1.1, 0.4
local passed = 0.65                   -- the share of a ball's worth that is left when a mate has got to it
local back_rad = 1.75
local behind_goal_m = 0.4             -- a shot is aimed there: a ball on the line goes in as well

local forgets_s, same_m = 4, 0.6      -- a robot that was seen there, and is out of sight

-- To be called in each tick: the others' robots as they were seen last. Looking away does not free the way.
function kicks.look(m, s, pose)
  local known = {}
  for _, robot in ipairs(field.robots(s, pose)) do
    if not robot.mate then known[#known + 1] = { x_m = robot.x_m, y_m = robot.y_m, mate = false, s = s.time_s } end
  end
  local seen = #known
  for _, old in ipairs(m.vars.others) do
    local again = s.time_s - old.s > forgets_s
    for i = 1, seen do again = again or field.distance(known[i], old) < same_m end
    if not again and #known < 6 then known[#known + 1] = old end
  end
  m.vars.others = known
end

-- Where this kick leaves the ball, it may not go on by itself.
function kicks.is_for_others(m, s) return game.may_kick(s) and game.touches_once(m, s) end

-- The others, and mates that told where they are, or are seen when they are silent; itself among them.
function kicks.robots(m, s, pose)
  local all = {}
  for i, robot in ipairs(m.vars.others) do all[i] = robot end
  for _, mate in pairs(m.vars.mates) do
    if s.time_s - mate.heard_s < 3 then all[#all + 1] = { x_m = mate.x_m, y_m = mate.y_m, mate = true } end
  end
  if not m.vars.heard then
    for _, robot in ipairs(field.robots(s, pose)) do
      if robot.mate then all[#all + 1] = robot end
    end
  end
  all[#all + 1] = { x_m = pose.x_m, y_m = pose.y_m, mate = true, kicks = true, leaves_ball = kicks.is_for_others(m, s) }
  return all
end

local function at_the_goal(me, ball, list)
  local x_m, post_m = me.length_m / 2 + behind_goal_m, me.goal_m / 2
  for _, y_m in ipairs { 0, -0.3 * post_m, 0.3 * post_m, -0.6 * post_m, 0.6 * post_m, ball.y_m } do
    if math.abs(y_m) < post_m - 0.15 then
      list[#list + 1] = { name = "shoot", x_m = x_m, y_m = y_m, beyond_m = 1.5 }
    end
  end
end

local function to_mates(m, s, list)
  for number, mate in pairs(m.vars.mates) do
    if number ~= s.seen.me.keeper and mate.plays and s.time_s - mate.heard_s < 3 then
      list[#list + 1] = { name = "pass", to = number, x_m = mate.x_m + pass_ahead_m, y_m = mate.y_m, beyond_m = 0.2 }
    end
  end
end

-- Ahead, and as it comes to the ball, but not back.
local function ahead(ball, toward_rad, list)
  for _, rad in ipairs { 0, -0.5, 0.5, -1, 1, -1.5, 1.5, toward_rad, toward_rad - 0.4, toward_rad + 0.4 } do
    if math.abs(field.angle(rad)) < back_rad then
      list[#list + 1] = {
        name = "dribble", x_m = ball.x_m + dribble_m * math.cos(rad), y_m = ball.y_m + dribble_m * math.sin(rad), beyond_m = 0,
      }
    end
  end
end

-- What a radian of the way around the ball costs.
local function turns_cost(m, s, robots, ball)
  local vars, cost = m.vars, turns
  for _, robot in ipairs(robots) do
    if not robot.mate and field.distance(robot, ball) < presses_m then cost = pressed end
  end
  if not vars.rests or field.distance(vars.rests, ball) > 0.3 then
    vars.rests = { x_m = ball.x_m, y_m = ball.y_m, since_s = s.time_s }
  end
  return cost + hurry * math.max(0, s.time_s - vars.rests.since_s - hurries_s)
end

-- All that it may do with the ball, and what it is about to do, each with its worth.
function kicks.all(m, s, pose, ball, now)
  local me, can = s.seen.me, m.vars.can
  local robots, list = kicks.robots(m, s, pose), {}
  local toward_rad = math.atan2(ball.y_m - pose.y_m, ball.x_m - pose.x_m)
  at_the_goal(me, ball, list)
  if can.dribble then ahead(ball, toward_rad, list) end
  if can.pass then to_mates(m, s, list) end
  if now then list[#list + 1] = now end
  local cost, for_others = turns_cost(m, s, robots, ball), kicks.is_for_others(m, s)
  for _, kick in ipairs(list) do
    local rad = math.atan2(kick.y_m - ball.y_m, kick.x_m - ball.x_m)
    local out_m = math.max(
      math.abs(ball.x_m - stands_m * math.cos(rad)) - me.length_m / 2,
      math.abs(ball.y_m - stands_m * math.sin(rad)) - me.width_m / 2, 0)
    local share = (kick.name == "pass" or for_others and kick.name == "dribble") and passed or 1
    kick.worth = share * chance.of_kick(me, robots, ball, kick, kick.beyond_m, game.indirect(s)) -
      cost * math.max(0, math.abs(field.angle(rad - toward_rad)) - aside_rad) - beside * out_m
  end
  return list
end

-- The kick that it goes for.
function kicks.choose(m, s, pose, ball)
  local now = m.vars.kick
  if now and s.time_s - now.chosen_s < again_s and s.time_s >= now.chosen_s then return now end
  if now and (s.time_s - now.chosen_s > stale_s or field.distance(now.ball, ball) > moved_m) then now = nil end
  local list = kicks.all(m, s, pose, ball, now)
  local best = list[1]
  for _, kick in ipairs(list) do
    if kick.worth > best.worth then best = kick end
  end
  local margin = field.distance(pose, ball) < before_feet_m and better_near or better
  local chosen = now and best.worth < now.worth + margin and now or best
  chosen.chosen_s = s.time_s
  chosen.ball = chosen.ball or { x_m = ball.x_m, y_m = ball.y_m }
  m.vars.kick = chosen
  return chosen
end

return kicks

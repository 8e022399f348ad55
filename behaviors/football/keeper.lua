-- The keeper: before its goal, between its middle and the ball. It clears a ball that comes near, and throws itself before
-- one that rolls past it into the goal.
local field = require "field"
local game = require "game"
local legs = require "legs"
local rolling = require "rolling"
local search = require "search"
local striker = require "striker"

local keeper = {}

local least_m, most_m = 0.4, 0.9  -- how far before its goal it stands
local clears_m = 1.6  -- a ball nearer to the goal's middle is its own
local body_m = 0.18   -- what comes nearer than that to its middle it stops by standing there
local dives_m, dives_s = 1.1, 1.2  -- how far it reaches, and how early it lets itself fall
local calm_m = 3     -- from a ball that is farther it may look away,
local shoots_m = 0.8  -- and from one that rests with no opponent so near to it
local waits_s, looks_s = 6, 9
local at_once_m = 2.3              -- a kick from nearer than that leaves no time to see how fast it rolls

function keeper.clears(s, ball) return ball ~= nil and field.distance(ball, game.own_goal(s)) < clears_m end

-- Where a ball that rolls into the goal comes by the keeper, or nil. A kick from near is believed at once, one from afar
-- when it is seen how fast it rolls.
local function comes_by(s, pose, ball)
  local own, half_m = game.own_goal(s), s.seen.me.goal_m / 2 + 0.25
  if ball.kicked and field.distance(ball.kicked.from, own) < at_once_m then
    local in_goal_m = rolling.heads_for(ball.kicked, own.x_m)
    if in_goal_m and math.abs(in_goal_m) < half_m then return rolling.heads_for(ball.kicked, pose.x_m) end
  end
  if not ball.rolls then return nil end
  local _, in_goal_m = rolling.crosses(ball, ball.rolls, own.x_m)
  if not in_goal_m or math.abs(in_goal_m) > half_m then return nil end
  local in_s, y_m = rolling.crosses(ball, ball.rolls, pose.x_m)
  return in_s and in_s < dives_s and y_m or nil
end

-- Whether the ball is about to roll past it into the goal, and then on which side: "left", "right" or nil.
function keeper.passes(s, pose, ball)
  local y_m = ball and comes_by(s, pose, ball)
  if not y_m then return nil end
  local beside_m = (y_m - pose.y_m) * math.cos(pose.heading_rad)
  if math.abs(beside_m) < body_m or math.abs(beside_m) > dives_m then return nil end
  return beside_m > 0 and "left" or "right"
end

-- On the line from the ball to the goal's middle; farther out the farther the ball is, where it covers more of the goal.
local function place(s, ball)
  local own, me = game.own_goal(s), s.seen.me
  local toward = ball or { x_m = 0, y_m = 0 }
  local far_m = math.max(field.distance(toward, own), 0.1)
  local out_m = field.within(0.22 * far_m, least_m, most_m)
  if game.keeps_away(s) and far_m < me.mark_m + 1 then out_m = 0.05 end  -- a free kick near the goal: on its line
  local reach_m, share = me.goal_m / 2 - 0.3, out_m / far_m
  return {
    x_m = own.x_m + math.max(share * (toward.x_m - own.x_m), math.min(out_m, 0.3)),
    y_m = field.within(share * toward.y_m, -reach_m, reach_m),
  }
end

-- When neither it nor a mate knows for some time where the ball is, it turns around once, again and again.
local function looks(m, s, ball)
  m.vars.ball_known_s = ball and s.time_s or m.vars.ball_known_s or s.time_s
  local unknown_s = s.time_s - m.vars.ball_known_s
  return unknown_s > waits_s and unknown_s % (waits_s + looks_s) > waits_s
end

-- Nobody is about to shoot: it may look to both sides of the ball in turn, which stays in sight.
function keeper.is_calm(m, s, pose, ball)
  if not ball or game.keeps_away(s) or field.distance(pose, ball) > calm_m then return true end
  if ball.rolls then return false end
  for _, robot in ipairs(m.vars.others) do
    if field.distance(robot, ball) < shoots_m then return false end
  end
  return true
end

function keeper.play(m, s, pose, ball)
  local side = m.vars.can.dive and keeper.passes(s, pose, ball)
  if side then return legs.dive(m, s, side) end
  if game.penalty_kick(s) then return legs.stand(m, s) end
  if keeper.clears(s, ball) and not game.keeps_away(s) then return striker.play(m, s, pose, ball) end
  if looks(m, s, ball) then return search.play(m, s, nil) end
  local at, toward = place(s, ball), ball or { x_m = 0, y_m = 0 }
  if field.distance(pose, at) < 0.2 then at = { x_m = pose.x_m, y_m = pose.y_m } end
  if keeper.is_calm(m, s, pose, ball) then return legs.watch(m, s, pose, at, toward) end
  legs.go(m, s, pose, at, toward)
end

return keeper

-- The keeper: before its goal, between its middle and the ball. It clears a ball that comes near, and throws itself before
-- one that rolls past it into the goal.
local field = require "field"
local game = require "game"
local legs = require "legs"
local rolling = require "rolling"
local striker = require "striker"

local keeper = {}

local before_m = 0.5  -- how far before its goal it stands
local clears_m = 1.6  -- a ball nearer to the goal's middle is its own
local body_m = 0.18   -- what comes nearer than that to its middle it stops by standing there
local dives_m, dives_s = 1.3, 1.6  -- how far it reaches, and how early it lets itself fall

function keeper.clears(s, ball) return ball ~= nil and field.distance(ball, game.own_goal(s)) < clears_m end

-- Whether the ball is about to roll past it into the goal, and then on which side: "left", "right" or nil.
function keeper.passes(s, pose, ball)
  if not ball or not ball.rolls then return nil end
  local own = game.own_goal(s)
  local _, in_goal_m = rolling.crosses(ball, ball.rolls, own.x_m)
  if not in_goal_m or math.abs(in_goal_m) > s.seen.me.goal_m / 2 + 0.25 then return nil end
  local in_s, y_m = rolling.crosses(ball, ball.rolls, pose.x_m)
  if not in_s or in_s > dives_s then return nil end
  local beside_m = (y_m - pose.y_m) * math.cos(pose.heading_rad)
  if math.abs(beside_m) < body_m or math.abs(beside_m) > dives_m then return nil end
  return beside_m > 0 and "left" or "right"
end

local function place(s, ball)
  local own, me = game.own_goal(s), s.seen.me
  local toward = ball or { x_m = 0, y_m = 0 }
  local reach_m = me.goal_m / 2 - 0.3
  local share = before_m / math.max(toward.x_m - own.x_m, before_m)
  local on_line = game.keeps_away(s) and toward.x_m - own.x_m < me.mark_m + 1  -- a free kick near the goal
  return { x_m = own.x_m + (on_line and 0.05 or before_m), y_m = field.within(share * toward.y_m * 1.5, -reach_m, reach_m) }
end

function keeper.play(m, s, pose, ball)
  local side = m.vars.can.dive and keeper.passes(s, pose, ball)
  if side then return legs.dive(m, s, side) end
  if game.penalty_kick(s) then return legs.stand(m, s) end
  if keeper.clears(s, ball) and not game.keeps_away(s) then return striker.play(m, s, pose, ball) end
  local at, toward = place(s, ball), ball or { x_m = 0, y_m = 0 }
  if field.distance(pose, at) < 0.3 then at = { x_m = pose.x_m, y_m = pose.y_m } end
  legs.go(m, s, pose, at, toward)
end

return keeper

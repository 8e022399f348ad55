-- The keeper: before its goal, between its middle and the ball; it clears a ball that comes near.
local field = require "field"
local game = require "game"
local legs = require "legs"
local striker = require "striker"

local keeper = {}

local before_m = 0.5  -- how far before its goal it stands
local clears_m = 1.6  -- a ball nearer to the goal's middle is its own

function keeper.clears(s, ball) return ball ~= nil and field.distance(ball, game.own_goal(s)) < clears_m end

function keeper.play(m, s, pose, ball)
  if game.penalty_kick(s) then return legs.stand(m, s) end
  local own = game.own_goal(s)
  if keeper.clears(s, ball) and not game.keeps_away(s) then return striker.play(m, s, pose, ball) end
  local toward = ball or { x_m = 0, y_m = 0 }
  local reach_m = s.seen.me.goal_m / 2 - 0.3
  local share = before_m / math.max(toward.x_m - own.x_m, before_m)
  local place = { x_m = own.x_m + before_m, y_m = field.within(share * toward.y_m * 1.5, -reach_m, reach_m) }
  if field.distance(pose, place) < 0.3 then place = { x_m = pose.x_m, y_m = pose.y_m } end
  legs.go(m, s, pose, place, toward)
end

return keeper

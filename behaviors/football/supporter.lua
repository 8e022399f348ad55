-- The supporter: behind the striker and to the side, where a lost ball comes by.
local field = require "field"
local game = require "game"
local legs = require "legs"
local search = require "search"

local supporter = {}

function supporter.play(m, s, pose, ball)
  if game.penalty_kick(s) then return legs.stand(m, s) end
  if not ball then return search.play(m, s, pose) end
  local half_m, side_m = s.seen.me.length_m / 2, s.seen.me.width_m / 2
  local side = ball.y_m > 0 and -1 or 1
  local behind_m = game.keeps_away(s) and s.seen.me.circle_m + 1 or 1.6
  local place = {
    x_m = field.within(ball.x_m - behind_m, 0.8 - half_m, half_m - 1.5),
    y_m = field.within(ball.y_m + 0.8 * side, 0.5 - side_m, side_m - 0.5),
  }
  if field.distance(pose, place) < 0.4 then place = { x_m = pose.x_m, y_m = pose.y_m } end  -- near enough
  legs.go(m, s, pose, place, ball)
end

return supporter

-- The places before a kick-off: in the own half, those of the others' kick-off outside of the circle. And before a
-- penalty kick: one behind the ball, the keeper on its line, all others far from both.
local field = require "field"
local legs = require "legs"

local ready = {}

local penalty_kick = 3
local stand_s = 2  -- it stands so long before set begins

local function before_penalty_kick(me, ours, nth)
  local half_m = me.length_m / 2
  if me.number == me.keeper then return { x_m = ours and 0.5 - half_m or -half_m, y_m = 0 } end
  if ours and nth == 1 then return { x_m = half_m - me.mark_m - 0.6, y_m = 0 } end
  local far_m = half_m - me.mark_m - me.circle_m - 1
  return { x_m = ours and far_m or -far_m, y_m = (nth % 2 == 0 and 1 or -1) * 1.2 }
end

function ready.place(s)
  local me, ours = s.seen.me, s.seen.game.ours == 1
  local nth = me.number - ((me.keeper > 0 and me.keeper < me.number) and 1 or 0)  -- among those that are no keeper
  if s.seen.game.set_play == penalty_kick then return before_penalty_kick(me, ours, nth) end
  if me.number == me.keeper then return { x_m = 0.5 - me.length_m / 2, y_m = 0 } end
  local front_m = ours and -0.6 or -me.circle_m - 0.6
  if nth == 1 then return { x_m = front_m, y_m = 0 } end
  return { x_m = -me.circle_m - 0.9, y_m = (nth % 2 == 0 and 1 or -1) * 1.2 }
end

function ready.play(m, s, pose)
  local place = ready.place(s)
  local last = s.seen.game.secondary_s - s.seen.game.age_s < stand_s
  if last or field.distance(pose, place) < 0.2 and math.abs(pose.heading_rad) < 0.3 then return legs.stand(m, s) end
  legs.go(m, s, pose, place, { x_m = place.x_m + 5, y_m = place.y_m })
end

return ready

-- Where the ball is, from what perception says now and then: in the frame of walk.at, so that it stays while the robot
-- walks. A picture is old when it arrives; it is put where the robot was then.
local walk = require "walking"

local ball = {}

local ticks = 128          -- that are remembered, 1.28 s
local gain = 0.25          -- how much a picture counts beside what is known
local elsewhere_m = 0.4    -- a ball that far off is another one, or was moved,
local pictures = 2         -- when so many pictures say so

-- To be called in each tick, with the table that it keeps in m.vars. Returns { x_m =, y_m =, seen_s = }, or nil when the
-- ball was never seen; seen_s is the time of the last picture.
function ball.watch(m, s, known)
  known.at = known.at or {}
  known.at[math.floor(100 * s.time_s + 0.5) % ticks] = walk.at(m)
  local seen = s.seen.ball
  if not (seen.confidence > 0) then return nil end
  local picture_s = s.time_s - seen.age_s
  if known.seen_s and picture_s < known.seen_s + 1e-4 then return known end
  local at = known.at[math.floor(100 * picture_s + 0.5) % ticks] or walk.at(m)
  local c, n = math.cos(at.heading_rad), math.sin(at.heading_rad)
  local x_m, y_m = at.x_m + c * seen.x_m - n * seen.y_m, at.y_m + n * seen.x_m + c * seen.y_m
  known.seen_s = picture_s
  if known.x_m and (x_m - known.x_m) ^ 2 + (y_m - known.y_m) ^ 2 < elsewhere_m ^ 2 then
    known.x_m, known.y_m = known.x_m + gain * (x_m - known.x_m), known.y_m + gain * (y_m - known.y_m)
    known.off = 0
  else
    known.off = (known.off or 0) + 1
    if not known.x_m or known.off >= pictures then known.x_m, known.y_m, known.off = x_m, y_m, 0 end
  end
  return known
end

return ball

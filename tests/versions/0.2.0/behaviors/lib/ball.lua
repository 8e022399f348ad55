-- Where the ball is, from what perception says now and then: in the frame of walk.at, so that it stays while the robot
-- walks. A picture is old when it arrives; it is put where the robot was then.
local walk = require "walking"

local ball = {}

local ticks = 128          -- that are remembered, 1.28 s
local gain = 0.25          -- how much a picture counts beside what is known
local elsewhere_m = 0.4    -- a ball that far off is another one, or was moved,
local pictures = 2         -- when so many pictures say so

-- The newest picture when it is a new one, { x_m =, y_m =, s = }, or nil: where the ball was in the frame of walk.at, and
-- when. To be called in each tick, with the table that it keeps.
function ball.picture(m, s, known)
  known.at = known.at or {}
  known.at[math.floor(100 * s.time_s + 0.5) % ticks] = walk.at(m)
  local seen = s.seen.ball
  if not (seen.confidence > 0) then return nil end
  local picture_s = s.time_s - seen.age_s
  if known.seen_s and picture_s < known.seen_s + 1e-4 then return nil end
  local at = known.at[math.floor(100 * picture_s + 0.5) % ticks] or walk.at(m)
  local x_m, y_m = walk.seen_from(at, seen.x_m, seen.y_m)
  known.seen_s = picture_s
  return { x_m = x_m, y_m = y_m, s = picture_s }
end

-- To be called in each tick, with the table that it keeps in m.vars. Returns { x_m =, y_m =, seen_s = }, or nil when the
-- ball was never seen; seen_s is the time of the last picture.
function ball.watch(m, s, known)
  local picture = ball.picture(m, s, known)
  if not picture then return known.x_m and s.seen.ball.confidence > 0 and known or nil end
  local x_m, y_m = picture.x_m, picture.y_m
  if known.x_m and (x_m - known.x_m) ^ 2 + (y_m - known.y_m) ^ 2 < elsewhere_m ^ 2 then
    known.x_m, known.y_m = known.x_m + gain * (x_m - known.x_m), known.y_m + gain * (y_m - known.y_m)
    known.off = 0
  else
    known.off = (known.off or 0) + 1
    if not known.x_m or known.off >= pictures then known.x_m, known.y_m, known.off = x_m, y_m, 0 end
  end
  return known
end

local around_m = 0.6  -- radius of the way around the ball

-- How it goes to the ball: how fast it turns, by which power of the cosine it slows meanwhile, from where on it goes
-- without turning away, and how near to its place it may ask for the kick.
local usual = { turn_rad_s = 0.6, slows = 3, beside_m = 0.5, kicks_m = 0.2 }
ball.quick = { turn_rad_s = 0.75, slows = 2, beside_m = 0.4, kicks_m = 0.25 }

-- Walks toward a place, facing it.
local function toward(m, at, x_m, y_m, most_m_s, way)
  local turn_rad = walk.angle(math.atan2(y_m - at.y_m, x_m - at.x_m) - at.heading_rad)
  walk.go(m, walk.slowed {
    forward_m_s = most_m_s * math.max(0, math.cos(turn_rad)) ^ way.slows,
    turn_rad_s = walk.within(1.5 * turn_rad, way.turn_rad_s),
  })
end

-- Turns to where the ball was last, by the table that ball.watch keeps.
function ball.search(m, known)
  local at = walk.at(m)
  local turn_rad = known.x_m and walk.angle(math.atan2(known.y_m - at.y_m, known.x_m - at.x_m) - at.heading_rad) or 1
  walk.go(m, { turn_rad_s = turn_rad > 0 and 0.6 or -0.6 })
end

-- How the robot is to the ball when that shall go toward rad: how far behind it, and how far to the left of its way.
function ball.beside(at, b, rad)
  local ux, uy = math.cos(rad), math.sin(rad)
  local x_m, y_m = at.x_m - b.x_m, at.y_m - b.y_m
  return -(ux * x_m + uy * y_m), ux * y_m - uy * x_m
end

-- Whether it is so far behind the ball that it need not go around it.
function ball.is_ahead(behind, left) return behind > 0.15 and math.abs(left) < 0.15 + 0.7 * (behind - 0.15) end

-- In each tick: a step of the way around the ball, to behind it.
function ball.around(m, b, rad, most_m_s, way)
  local at = walk.at(m)
  local ux, uy = math.cos(rad), math.sin(rad)
  local behind, left = ball.beside(at, b, rad)
  local from_rad = math.atan2(left, behind)  -- about the ball, 0 behind it
  local to_rad = from_rad - walk.within(from_rad, 0.8)
  local c, n = math.cos(to_rad), math.sin(to_rad)
  toward(m, at, b.x_m - around_m * (c * ux + n * uy), b.y_m - around_m * (c * uy - n * ux), most_m_s, way or usual)
end

-- The foot that the ball is before, for m.vars.side: 1 the left one.
function ball.side(left, side)
  if math.abs(left) > 0.04 then return left > 0 and -1 or 1 end  -- on its left: the ball is before the right foot
  return side
end

-- In each tick: a step of the way around the ball b until it is between the robot and the target, and then the kick, so
-- that the ball rolls beyond_m farther than the target on a ground that slows it by roll_m_s2. All in the frame of
-- walk.at, at most_m_s (0.35), in the usual way or as quick. m.vars.side is the foot: 1 the left one. False: it is not
-- behind the ball, and a kick that it was to do is taken back.
function ball.approach(m, b, target, beyond_m, roll_m_s2, most_m_s, way)
  most_m_s, way = most_m_s or 0.35, way or usual
  local at = walk.at(m)
  local rad = math.atan2(target.y_m - b.y_m, target.x_m - b.x_m)
  local behind, left = ball.beside(at, b, rad)
  m.vars.side = ball.side(left, m.vars.side)
  if not ball.is_ahead(behind, left) then
    walk.keep(m)
    ball.around(m, b, rad, most_m_s, way)
    return false
  end
  local place = walk.to_kick(b, rad, m.vars.side, rad)
  local off_m = walk.distance(place, at)
  if off_m > way.beside_m then
    toward(m, at, place.x_m, place.y_m, most_m_s, way)
    return true
  end
  walk.beside(m, place)
  if off_m < way.kicks_m and math.abs(walk.angle(rad - at.heading_rad)) < 0.3 then
    walk.kick(m, b, rad, math.min(walk.distance(target, b) + beyond_m, 4.5), roll_m_s2)
  end
  return true
end

return ball

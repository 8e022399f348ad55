-- How the ball rolls, by where it was seen in the last half second, and where that ends.
local field = require "field"

local rolling = {}

local remembers_s, least = 0.5, 3  -- sightings; fewer than so many say nothing
local fastest_m_s, beside_m = 3.5, 0.3  -- what is farther from the last sighting than a kick takes it, is no ball
local rolls_m_s = 0.35             -- what is slower rests
rolling.slows_m_s2 = 0.28

local function note(known, picture_s, at)
  local last = known.seen[#known.seen]
  if last then
    local far_m = beside_m + fastest_m_s * (picture_s - last.s)
    local odd = field.distance(at, last) > far_m
    if odd and not known.odd then known.odd = true return end
    if odd then known.seen = {} end
  end
  known.odd = false
  known.seen[#known.seen + 1] = { s = picture_s, x_m = at.x_m, y_m = at.y_m }
  while picture_s - known.seen[1].s > remembers_s do table.remove(known.seen, 1) end
end

-- The line through the sightings, by least squares.
local function velocity(seen)
  local s, x_m, y_m = 0, 0, 0
  for _, one in ipairs(seen) do s, x_m, y_m = s + one.s, x_m + one.x_m, y_m + one.y_m end
  s, x_m, y_m = s / #seen, x_m / #seen, y_m / #seen
  local ss, sx, sy = 0, 0, 0
  for _, one in ipairs(seen) do
    ss, sx, sy = ss + (one.s - s) ^ 2, sx + (one.s - s) * (one.x_m - x_m), sy + (one.s - s) * (one.y_m - y_m)
  end
  if ss < 1e-6 then return 0, 0 end
  return sx / ss, sy / ss
end

-- To be called in each tick with the table that it keeps: { x_m_s =, y_m_s =, m_s = }, or nil for a ball that rests or
-- is not known well enough.
function rolling.watch(known, s, pose)
  local ball = s.seen.ball
  known.seen = known.seen or {}
  if not (ball.confidence > 0) or not ball.carried or ball.age_s > remembers_s then
    known.seen = {}
    return nil
  end
  local picture_s = s.time_s - ball.age_s
  if not known.last_s or picture_s > known.last_s + 1e-3 then
    known.last_s = picture_s
    note(known, picture_s, field.from_robot(pose, ball.x_m, ball.y_m))
  end
  if #known.seen < least then return nil end
  local x_m_s, y_m_s = velocity(known.seen)
  local m_s = math.sqrt(x_m_s ^ 2 + y_m_s ^ 2)
  if m_s < rolls_m_s then return nil end
  return { x_m_s = x_m_s, y_m_s = y_m_s, m_s = m_s }
end

-- Where a ball that is `at` and rolls so comes to rest.
function rolling.rest(at, rolls)
  local share = rolls.m_s / (2 * rolling.slows_m_s2)
  return { x_m = at.x_m + share * rolls.x_m_s, y_m = at.y_m + share * rolls.y_m_s }
end

-- When and where it crosses x_m: seconds and y, or nil when it rests before, or rolls the other way.
function rolling.crosses(at, rolls, x_m)
  local ahead_m = x_m - at.x_m
  if ahead_m * rolls.x_m_s <= 0 then return nil end
  local path_m = ahead_m / rolls.x_m_s * rolls.m_s
  local left = rolls.m_s ^ 2 - 2 * rolling.slows_m_s2 * path_m
  if left < 0 then return nil end
  return (rolls.m_s - math.sqrt(left)) / rolling.slows_m_s2, at.y_m + ahead_m / rolls.x_m_s * rolls.y_m_s
end

return rolling

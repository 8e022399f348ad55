-- Where the ball is by what the robot sees itself, how it rolls, and where that ends. A picture may show a ball where none
-- is: one that does not fit to what was seen before counts when the next one says the same.
local field = require "field"

local rolling = {}

local remembers_s, least = 0.5, 3  -- sightings that say how it rolls; fewer than so many say nothing
local knows_s, rolling_s = 5, 2     -- so long a ball is where it was seen last; one that rolled
local fastest_m_s, beside_m = 3.5, 0.3  -- what is farther from the last sighting than a kick takes it, does not fit
local rolls_m_s = 0.35             -- what is slower rests
rolling.slows_m_s2 = 0.28

local kicked_m, short_s = 0.2, 0.8   -- a ball that lay, and is so far from there, was kicked; and how long that is news

local function fits(at, before)
  return before and field.distance(at, before) < beside_m + fastest_m_s * math.min(at.s - before.s, 0.3)
end

local function note(known, at)
  local seen = known.seen
  if fits(at, seen[#seen]) then
    known.odd = nil
  elseif fits(at, known.odd) then
    seen = { known.odd }
    known.seen, known.odd = seen, nil
  else
    known.odd = at
    return
  end
  seen[#seen + 1] = at
  while at.s - seen[1].s > remembers_s do table.remove(seen, 1) end
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

-- A kick shows in two pictures, long before its speed does: where the ball lay, and where it is now.
local function note_kick(known, at)
  local lay = known.lay
  if not lay or at.s - lay.s > knows_s then
    known.lay = { x_m = at.x_m, y_m = at.y_m, s = at.s }
  elseif field.distance(at, lay) < kicked_m then
    lay.x_m, lay.y_m, lay.s = lay.x_m + 0.15 * (at.x_m - lay.x_m), lay.y_m + 0.15 * (at.y_m - lay.y_m), at.s
  elseif known.gone then
    known.kick = { from = lay, s = at.s }
    known.lay, known.gone = { x_m = at.x_m, y_m = at.y_m, s = at.s }, nil
    return
  else
    known.gone = true
    return
  end
  known.gone = nil
end

local function how(seen)
  if #seen < least then return nil end
  local x_m_s, y_m_s = velocity(seen)
  local m_s = math.sqrt(x_m_s ^ 2 + y_m_s ^ 2)
  return m_s > rolls_m_s and { x_m_s = x_m_s, y_m_s = y_m_s, m_s = m_s } or nil
end

local function mean(seen)
  local x_m, y_m = 0, 0
  for _, one in ipairs(seen) do x_m, y_m = x_m + one.x_m, y_m + one.y_m end
  return { x_m = x_m / #seen, y_m = y_m / #seen }
end

-- To be called in each tick with the table that it keeps: { x_m =, y_m =, rolls =, rest = }, on the field, or nil. rolls is
-- { x_m_s =, y_m_s =, m_s = }, nil for a ball that rests or is not known well enough; rest is where it will lie. kicked says
-- of a kick just now where it came from, and where the ball is.
function rolling.watch(known, s, pose)
  local ball = s.seen.ball
  known.seen = known.seen or {}
  if not (ball.confidence > 0) or not ball.carried then
    known.seen, known.odd = {}, nil
    return nil
  end
  local picture_s = s.time_s - ball.age_s
  if not known.picture_s or picture_s > known.picture_s + 1e-3 then
    known.picture_s = picture_s
    local at = field.from_robot(pose, ball.x_m, ball.y_m)
    at.s = picture_s
    note(known, at)
    if known.seen[#known.seen] == at then note_kick(known, at) end
  end
  local seen = known.seen
  local last = seen[#seen]
  if not last then return nil end
  local rolls = how(seen)
  if s.time_s - last.s > (rolls and rolling_s or knows_s) then return nil end
  local at = rolls and { x_m = last.x_m, y_m = last.y_m } or mean(seen)
  at.rolls = rolls
  at.age_s = s.time_s - last.s
  at.rest = rolls and rolling.rest(at, rolls) or at
  local kick = known.kick
  if kick and s.time_s - kick.s < short_s then at.kicked = { from = kick.from, x_m = last.x_m, y_m = last.y_m } end
  return at
end

-- Where a ball that was kicked just now will cross x_m, or nil when it does not go there.
function rolling.heads_for(kicked, x_m)
  local gone_m, ahead_m = kicked.x_m - kicked.from.x_m, x_m - kicked.from.x_m
  if gone_m * ahead_m <= 0 or math.abs(gone_m) < 0.1 then return nil end
  return kicked.from.y_m + ahead_m / gone_m * (kicked.y_m - kicked.from.y_m)
end

-- Where a ball that is `at` and rolls so comes to rest.
function rolling.rest(at, rolls)
  local share = rolls.m_s / (2 * rolling.slows_m_s2)
  return { x_m = at.x_m + share * rolls.x_m_s, y_m = at.y_m + share * rolls.y_m_s }
end

-- Where one that was `at` and rolled so is in_s later.
function rolling.on(at, x_m_s, y_m_s, in_s)
  local m_s = math.sqrt(x_m_s ^ 2 + y_m_s ^ 2)
  if m_s < 1e-6 then return at end
  local rolls_s = math.min(in_s, m_s / rolling.slows_m_s2)
  local share_s = rolls_s - rolling.slows_m_s2 * rolls_s ^ 2 / (2 * m_s)
  return { x_m = at.x_m + share_s * x_m_s, y_m = at.y_m + share_s * y_m_s }
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

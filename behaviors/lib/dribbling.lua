-- Dribbles: moves the ball ahead along a line by short kicks, and does not stand between them. A kick is a step of the
-- walk; the robot walks after the ball and meets it again when that has nearly come to rest.
local ball = require "ball"
local walk = require "walking"

local dribble = {}

-- The ball as it is followed: by what share a picture changes where it is thought to be, and its velocity, per second.
local share, velocity_per_s = 0.3, 0.6
local elsewhere_m, pictures = 0.5, 2  -- a ball that far off is another one, when so many pictures say so

-- What a kick is asked for. Its speed is that of the foot that swings anyhow: a foot that is led more slowly to where
-- the ball lies is faster before, and a ball that lies nearer than it is thought to flies off.
local kick = { far_m = 2.2, roll_m_s2 = 0.28, ahead_m = 0.3, rad = 0.3 }
local strike_s, landed_s = 0.2, 0.1  -- from lift-off to the strike, and from there to the landing
local leaves_m_s = 1.2               -- how fast the ball rolls after it

-- How the walk is while it dribbles: kicks reach less far ahead, as the foot is slower there, and a foot that touches the
-- ball late in its swing has not landed. Feet far apart slide, and a robot that goes to a side to have the ball before a
-- foot has them far apart.
local meanwhile = { ["kick.near_m"] = -0.08, ["kick.far_m"] = 0.09, early_share = 0.85, apart_max_m = 0.28 }

-- Moves the ball on by dt_s; the ground slows it.
local function roll(b, dt_s, roll_m_s2)
  local m_s = math.sqrt(b.x_m_s ^ 2 + b.y_m_s ^ 2)
  local left = m_s > 0 and math.max(0, 1 - roll_m_s2 * dt_s / m_s) or 0
  b.x_m, b.y_m = b.x_m + dt_s * b.x_m_s, b.y_m + dt_s * b.y_m_s
  b.x_m_s, b.y_m_s = left * b.x_m_s, left * b.y_m_s
end

local function lies_at(b, x_m, y_m) b.x_m, b.y_m, b.x_m_s, b.y_m_s, b.off = x_m, y_m, 0, 0, 0 end

local function correct(b, picture, now_s)
  local age_s = now_s - picture.s
  local x_m, y_m = picture.x_m + age_s * b.x_m_s - b.x_m, picture.y_m + age_s * b.y_m_s - b.y_m
  if x_m ^ 2 + y_m ^ 2 < elsewhere_m ^ 2 then
    b.x_m, b.y_m, b.off = b.x_m + share * x_m, b.y_m + share * y_m, 0
    b.x_m_s, b.y_m_s = b.x_m_s + velocity_per_s * x_m, b.y_m_s + velocity_per_s * y_m
    return
  end
  b.off = b.off + 1
  if b.off >= pictures then lies_at(b, picture.x_m, picture.y_m) end
end

-- To be called in each tick, with the table that it keeps in m.vars. Returns where the ball is now in the frame of
-- walk.at and how it rolls, { x_m =, y_m =, x_m_s =, y_m_s =, seen_s = }, or nil when it was never seen.
function dribble.watch(m, s, known, roll_m_s2)
  if known.x_m then roll(known, s.time_s - known.now_s, roll_m_s2) end
  known.now_s = s.time_s
  local picture = ball.picture(m, s, known)
  if picture and not known.x_m then
    lies_at(known, picture.x_m, picture.y_m)
  elseif picture then
    correct(known, picture, s.time_s)
  end
  return known.x_m and known or nil
end

-- Before the first dribble.along, and after the last: what the walk does otherwise in `kept`.
function dribble.begin(m, kept)
  for name, value in pairs(meanwhile) do
    kept[name] = kept[name] or m.walk:parameter(name)
    m.walk:set_parameter(name, value)
  end
end
function dribble.finish(m, kept)
  walk.keep(m)
  for name in pairs(meanwhile) do
    if kept[name] then m.walk:set_parameter(name, kept[name]) end
  end
end

-- A foot that kicked has landed: how the ball rolls since, long before pictures tell.
local function kicked(b, roll_m_s2)
  b.x_m_s, b.y_m_s = leaves_m_s * math.cos(b.rad), leaves_m_s * math.sin(b.rad)
  roll(b, landed_s, roll_m_s2)
end

-- Walks to where the ball is before a foot, `ahead_m` and `left_m` away: slower while it is beside that place, as a ball
-- that another part of the foot meets goes elsewhere.
local function come(m, b, ahead_m, left_m, turn_rad, most_m_s)
  local heading_rad = walk.at(m).heading_rad
  local rolls_m_s = math.cos(heading_rad) * b.x_m_s + math.sin(heading_rad) * b.y_m_s
  local forward_m_s = 0.03 + math.max(0, rolls_m_s) + 1.5 * ahead_m
  local aside_s = math.max(0, math.abs(left_m) - 0.04) / 0.12
  if aside_s > 0 then forward_m_s = math.min(forward_m_s, (ahead_m - 0.05) / aside_s) end
  walk.go(m, walk.slowed {
    forward_m_s = math.max(-0.1, math.min(most_m_s, forward_m_s)),
    left_m_s = walk.within(1.7 * left_m, 0.12),
    turn_rad_s = walk.within(1.5 * turn_rad, 0.4),
  })
end

-- In each tick: a step of the dribble of the ball that dribble.watch says, along the line through the place
-- { x_m =, y_m = } toward rad, at most at most_m_s. The ball comes back to the line over back_m. m.vars.side is the foot,
-- as for ball.approach.
function dribble.along(m, b, line, most_m_s, back_m)
  if b.armed and not walk.kicks(m) then kicked(b, kick.roll_m_s2) end
  b.armed = walk.kicks(m)
  local at = walk.at(m)
  local soon = { x_m = b.x_m + strike_s * b.x_m_s, y_m = b.y_m + strike_s * b.y_m_s }
  local _, off = ball.beside(soon, line, line.rad)
  local rad = walk.angle(line.rad - math.atan2(off, back_m))
  local behind, left = ball.beside(at, soon, rad)
  m.vars.side = ball.side(left, m.vars.side)
  if behind < 0 or math.abs(left) > 0.3 + 0.7 * behind then
    walk.keep(m)
    return ball.around(m, soon, rad, most_m_s)
  end
  local ahead_m, left_m = walk.as_seen(at, walk.to_kick(soon, rad, m.vars.side, rad))
  local near = math.max(0, math.min(1, ahead_m / 0.4))  -- what is far is gone to, what is near is faced
  local turn_rad = walk.angle(rad + near * walk.within(1.5 * left_m, 0.3) - at.heading_rad)
  come(m, b, ahead_m, left_m, turn_rad, most_m_s)
  if math.abs(ahead_m) < kick.ahead_m and math.abs(turn_rad) < kick.rad then
    walk.kick(m, soon, rad, kick.far_m, kick.roll_m_s2)
    b.rad = rad
  elseif b.armed then
    walk.keep(m)
  end
end

return dribble

-- Who does what, agreed without a master: each says how long it takes to the ball, and each sees by the same rule who is
-- the striker. Who is silent or may not play is not there.
local field = require "field"
local game = require "game"
local keeper = require "keeper"

local roles = {}

local keeps_s = 1.5   -- who is the striker stays it, unless another one is faster by that
local rises_s = 8
local saves_s = 20    -- longer: a mate with more in its battery goes
local unknown_s = 60  -- to a ball that it does not know, or must leave to others
local walks_m_s, turns_rad_s = 0.3, 0.6

local function own_way(m, pose, ball)
  return roles.far(pose, ball, m.vars.lies) + (m.vars.saves and saves_s or 0)
end

-- What it tells its mates about its way to the ball.
function roles.told(m, pose, ball) return m.vars.leaves_ball and unknown_s or own_way(m, pose, ball) end

-- Seconds to stand behind the ball, facing the others' goal; more for one that lies.
function roles.far(pose, ball, lies)
  if not ball then return unknown_s end
  if lies then return rises_s + roles.far(pose, ball) end
  local rest = ball.rest or ball
  local behind = { x_m = rest.x_m - 0.4, y_m = rest.y_m }
  local toward_rad = math.atan2(ball.y_m - pose.y_m, ball.x_m - pose.x_m)
  return field.distance(pose, behind) / walks_m_s + math.abs(field.angle(toward_rad - pose.heading_rad)) / turns_rad_s
end

local function has_mates(m, s)
  for _, mate in pairs(m.vars.mates) do
    if game.plays(s, mate) then return true end
  end
  return false
end

-- The keeper clears this ball, as long as it is on the field and on its feet.
local function is_the_keepers(m, s, ball, own_s)
  local mate = m.vars.mates[s.seen.me.keeper]
  return keeper.clears(s, ball) and game.plays(s, mate) and mate.far_s < own_s + rises_s / 2
end

-- All its mates are off the field: nobody goes to the ball but the keeper, unless an opponent is there sooner, who may
-- kick it. Mates that were never heard are silent, and play.
local function keeper_goes(m, s, pose, ball)
  if not m.vars.heard or not ball or has_mates(m, s) or game.keeps_away(s) then return false end
  if game.may_kick(s) then return true end
  local own_m = field.distance(pose, ball.rest or ball) - (m.vars.role == "striker" and 0.5 or 0)
  for _, robot in ipairs(m.vars.others) do
    if field.distance(robot, ball.rest or ball) < own_m + 1 then return false end
  end
  return true
end

function roles.pick(m, s, pose, ball)
  local me = s.seen.me
  if m.vars.leaves_ball then return me.number == me.keeper and "keeper" or "supporter" end
  if me.number == me.keeper then return keeper_goes(m, s, pose, ball) and "striker" or "keeper" end
  local own_s = own_way(m, pose, ball) - (m.vars.role == "striker" and keeps_s or 0)
  for number, mate in pairs(m.vars.mates) do
    if (number ~= me.keeper or mate.role == "striker") and game.plays(s, mate) then
      local their_s = mate.far_s - (mate.role == "striker" and keeps_s or 0)
      if their_s < own_s or (their_s == own_s and number < me.number) then return "supporter" end
    end
  end
  return is_the_keepers(m, s, ball, own_s) and "supporter" or "striker"
end

return roles

-- What the referee's words mean for a robot: what it may do now.
local field = require "field"
local rolling = require "rolling"

local game = {}

local set, playing = 2, 3
local low, empty = 0.15, 0.03  -- of a full battery

-- "wait": it stands; "ready": it goes to its place for the kick-off; "play".
function game.phase(s, m)
  local told = s.seen.game
  if not (told.confidence > 0) or told.penalty > 0.5 or told.stopped > 0.5 then return "wait" end
  if game.charge(s) < empty then return "wait" end
  if told.state == 1 then return "ready" end
  if told.state == set then return m.vars.whistled and "play" or "wait" end
  return told.state == playing and "play" or "wait"
end

-- The share that is left in its battery; 1 where nothing tells of it. Who is empty stands, before its legs give way.
function game.charge(s)
  local battery = s.seen.battery
  return battery and battery.confidence > 0 and battery.charge or 1
end

-- It goes to the ball only when no mate does, and nowhere else.
function game.saves(s) return game.charge(s) < low end

-- The whistle tells of playing 10 s before the game controller does; to be called in each tick.
function game.listen(m, s)
  local whistle, told = s.seen.whistle, s.seen.game
  local count = whistle.confidence > 0 and whistle.count or 0
  local state = told.confidence > 0 and told.state or 0
  if state ~= set then m.vars.whistled = false end
  if state == set and count > m.vars.whistles then m.vars.whistled = true end
  m.vars.whistles = math.max(m.vars.whistles, count)
end

-- A kick-off of which the game controller does not say yet that it is over: "ours", "theirs", or nil.
function game.kick_off(s, m)
  local told = s.seen.game
  if told.state ~= set or not m.vars.whistled or told.set_play > 0 then return nil end
  return told.ours == 1 and "ours" or told.ours == 0 and "theirs" or nil
end

-- A free kick, throw-in and so on of the others, from whose ball the team keeps away.
function game.keeps_away(s)
  local told = s.seen.game
  return told.state == playing and told.set_play > 0 and told.ours == 0
end

-- A free kick, throw-in and so on of its own, other than a penalty kick: the others keep away from the ball.
function game.may_kick(s)
  local told = s.seen.game
  return told.state == playing and told.set_play > 0 and told.set_play ~= 3 and told.ours == 1
end

-- A penalty kick that is not taken yet: only the kicker moves.
function game.penalty_kick(s) return s.seen.game.set_play == 3 end

-- A goal kick of the others, for which all leave their penalty area.
function game.their_goal_kick(s) return game.keeps_away(s) and s.seen.game.set_play == 5 end

-- An indirect free kick or a throw-in of its own: no goal counts straight from it.
function game.indirect(s)
  local told = s.seen.game
  return told.ours == 1 and (told.set_play == 2 or told.set_play == 4)
end

-- Whether a mate is on the field: who is silent or may not play is not there.
local silent_s = 4
function game.plays(s, mate) return mate ~= nil and s.time_s - mate.heard_s < silent_s and mate.plays end

-- Who takes a free kick, throw-in and so on may not touch the ball again before another robot has, in a team of three or
-- more on the field.
local three = 3
function game.touches_once(m, s)
  if not m.vars.heard then return s.seen.me.players >= three end
  local count = 1
  for _, mate in pairs(m.vars.mates) do
    if game.plays(s, mate) then count = count + 1 end
  end
  return count >= three
end

-- To be called in each tick: whether it must leave the ball to others, because it took such a kick. It took one when it
-- was at the ball, and play is free and the ball gone. After waits_s it waits no longer for others, who may not have seen
-- the kick.
local at_ball_m, gone_m, touched_m, soon_s, waits_s = 0.7, 0.15, 0.45, 1.5, 20
function game.leaves_ball(m, s, pose, ball)
  local vars = m.vars
  if s.seen.game.set_play > 0 then
    vars.took_s = false
    if ball and game.may_kick(s) and vars.role ~= "supporter" and field.distance(pose, ball) < at_ball_m then
      vars.takes = { x_m = ball.x_m, y_m = ball.y_m, s = s.time_s }
    end
    return false
  end
  local takes = vars.takes
  if takes and ball and field.distance(takes, ball) > gone_m and game.touches_once(m, s) then
    vars.takes, vars.took_s = false, s.time_s
  elseif takes and s.time_s - takes.s > soon_s then
    vars.takes = false
  end
  if not vars.took_s then return false end
  local touched = s.time_s - vars.took_s > waits_s
  for _, all in ipairs { vars.others, vars.mates } do
    for _, robot in pairs(all) do touched = touched or ball ~= nil and field.distance(robot, ball) < touched_m end
  end
  if touched then vars.took_s = false end
  return not touched
end

function game.goal(s) return { x_m = s.seen.me.length_m / 2, y_m = 0 } end
function game.own_goal(s) return { x_m = -s.seen.me.length_m / 2, y_m = 0 } end

-- Where the ball is by what the robot sees, or else by what its mates say: { x_m =, y_m =, own = }, or nil. What it
-- sees itself has rolls and rest, too (rolling.lua).
function game.ball(m, s, pose)
  local ball = rolling.watch(m.vars.rolling, s, pose)
  if ball then
    ball.own = true
    return ball
  end
  local best
  for _, mate in pairs(m.vars.mates) do
    if mate.ball_x_m and s.time_s - mate.ball_s < 5 and (not best or mate.ball_s > best.ball_s) then best = mate end
  end
  if not best then return nil end
  local at = rolling.on({ x_m = best.ball_x_m, y_m = best.ball_y_m }, best.ball_x_m_s, best.ball_y_m_s, s.time_s - best.ball_s)
  return { x_m = at.x_m, y_m = at.y_m, own = false }
end

return game

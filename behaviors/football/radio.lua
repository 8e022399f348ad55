-- What robots of the team tell each other, and when. How much a message is worth to the mates, and what the budget of the
-- game leaves, comes with the entry `radio`; news of another role or pass go out at once.
local k = require "kadans"
local field = require "field"
local game = require "game"
local roles = require "roles"

local radio = {}

radio.tells = {
  "what a mate knows and does",
  number = { "", min = 1, max = 20 }, role = k.text, plays = k.flag, far_s = { "s", min = -10, max = 1000 },
  x_m = { "m", min = -20, max = 20 }, y_m = { "m", min = -20, max = 20 },
  ball_x_m = { "m", min = -20, max = 20, optional = true }, ball_y_m = { "m", min = -20, max = 20, optional = true },
  ball_x_m_s = { "m/s", min = -10, max = 10, optional = true }, ball_y_m_s = { "m/s", min = -10, max = 10, optional = true },
  ball_age_s = { "s", min = 0, max = 60, optional = true, doc = "since it saw the ball" },
  pass_to = { "", min = 1, max = 20, optional = true, doc = "the mate that it is about to pass to" },
}

local soonest_s = 0.3  -- between two messages that tell news
local passes_m = 0.9   -- a pass is told when the ball is so near: until then the mate goes on to its place

function radio.hear(m, s)
  local said = s.event.data
  m.vars.heard = true
  m.vars.mates[said.number] = {
    heard_s = s.time_s, role = said.role, plays = said.plays, far_s = said.far_s,
    x_m = said.x_m, y_m = said.y_m, pass_to = said.pass_to, ball_x_m = said.ball_x_m, ball_y_m = said.ball_y_m,
    ball_x_m_s = said.ball_x_m_s or 0, ball_y_m_s = said.ball_y_m_s or 0, ball_s = s.time_s - (said.ball_age_s or 0),
  }
end

-- Whether it tells now. Without the entry it tells each tell_s.
function radio.is_due(m, s, news, tell_s)
  local silent_s, advice = s.time_s - m.vars.told_s, s.seen.radio
  if not (advice.confidence > 0) then return silent_s >= (news and soonest_s or tell_s) end
  if advice.left < 1 then return false end
  return advice.say > m.vars.told_say or (news and silent_s >= soonest_s)
end

local function within(value, most) return value and field.within(value, -most, most) end

-- The mate that it is about to pass to, or false.
local function receiver(m, s, pose, ball)
  local kick = m.vars.kick
  if m.vars.role ~= "striker" or not kick or not ball or s.time_s - kick.chosen_s > 1 then return false end
  return field.distance(pose, ball) < passes_m and kick.to or false
end

function radio.tell(m, s, pose, ball, tell_s)
  if s.seen.me.players < 2 then return end
  local vars = m.vars
  local pass_to = receiver(m, s, pose, ball)
  local news = vars.role ~= vars.told_role or pass_to ~= vars.told_pass
  if not radio.is_due(m, s, news, tell_s) then return end
  vars.told_s, vars.told_role, vars.told_pass = s.time_s, vars.role, pass_to
  if s.seen.radio.confidence > 0 then vars.told_say = s.seen.radio.say end
  local own = ball and ball.own and ball or {}
  local rolls = own.rolls or {}
  m:send("robot.tell", {
    number = s.seen.me.number, role = vars.role, plays = game.phase(s, m) == "play", far_s = roles.told(m, pose, ball),
    x_m = within(pose.x_m, 20), y_m = within(pose.y_m, 20), pass_to = pass_to or nil,
    ball_x_m = within(own.x_m, 20), ball_y_m = within(own.y_m, 20), ball_age_s = own.age_s,
    ball_x_m_s = within(rolls.x_m_s, 10), ball_y_m_s = within(rolls.y_m_s, 10),
  })
end

return radio

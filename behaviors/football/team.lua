-- A football team of two, three or four: what each robot decides, 20 times a second. The plays stand in files of their
-- own: ready, striker, supporter, keeper, search. What the robot knows is in s.seen (docs/football.md), what it does are
-- orders to `footwork`, and robot.tell is what it says to its mates.
local k = require "kadans"
local field = require "field"
local game = require "game"
local keeper = require "keeper"
local kicks = require "kicks"
local legs = require "legs"
local ready = require "ready"
local roles = require "roles"
local striker = require "striker"
local supporter = require "supporter"

local P = k.params {
  tell_s = { 1, min = 0.1, max = 60, unit = "s", doc = "how often it tells its mates while it plays" },
  passes = { 1, min = 0, max = 1, doc = "0: it never passes to a mate" },
  dribbles = { 1, min = 0, max = 1, doc = "0: it does without short kicks ahead" },
  supports = { 1, min = 0, max = 1, doc = "0: a supporter stands where it is" },
  dives  = { 1, min = 0, max = 1, doc = "0: the keeper stays on its feet" },
}

local events = {
  ["robot.tell"] = {
    "what a mate knows and does",
    number = { "", min = 1, max = 20 }, role = k.text, plays = k.flag, far_s = { "s", min = -10, max = 1000 },
    x_m = { "m", min = -20, max = 20 }, y_m = { "m", min = -20, max = 20 },
    ball_x_m = { "m", min = -20, max = 20, optional = true }, ball_y_m = { "m", min = -20, max = 20, optional = true },
    pass_to = { "", min = 1, max = 20, optional = true, doc = "the mate that it is about to pass to" },
  },
}
for name, order in pairs(require "foot_orders") do events[name] = order end
k.events(events)

local soonest_s = 0.3  -- between two messages

local plays = { striker = striker.play, supporter = supporter.play, keeper = keeper.play }

local function hear(m, s)
  local said = s.event.data
  m.vars.heard = true
  m.vars.mates[said.number] = {
    heard_s = s.time_s, role = said.role, plays = said.plays, far_s = said.far_s,
    x_m = said.x_m, y_m = said.y_m, ball_x_m = said.ball_x_m, ball_y_m = said.ball_y_m, pass_to = said.pass_to,
  }
end

-- Once a second, and at once when its role or its pass is another one.
local function tell(m, s, pose, ball)
  if s.seen.me.players < 2 then return end
  local vars = m.vars
  local pass_to = vars.role == "striker" and vars.kick and s.time_s - vars.kick.chosen_s < 1 and vars.kick.to or false
  local news = vars.role ~= vars.told_role or pass_to ~= vars.told_pass
  if s.time_s - vars.told_s < (news and soonest_s or P.tell_s) then return end
  vars.told_s, vars.told_role, vars.told_pass = s.time_s, vars.role, pass_to
  local own = ball and ball.own
  m:send("robot.tell", {
    number = s.seen.me.number, role = vars.role, plays = game.phase(s, m) == "play", far_s = roles.far(pose, ball, vars.lies),
    x_m = field.within(pose.x_m, -20, 20), y_m = field.within(pose.y_m, -20, 20), pass_to = pass_to or nil,
    ball_x_m = own and field.within(ball.x_m, -20, 20) or nil, ball_y_m = own and field.within(ball.y_m, -20, 20) or nil,
  })
end

-- A kick-off is over when the ball is out of the circle, or, for the others, when it has moved.
local function note_kick_off(m, s, ball)
  local kick_off = game.kick_off(s, m)
  if kick_off == "ours" then m.vars.kick_off_ours = true end
  m.vars.kick_off_theirs = kick_off == "theirs" and not (ball and field.distance(ball, { x_m = 0, y_m = 0 }) > 0.4)
end

local function play(m, s)
  game.listen(m, s)
  local pose = field.pose(s)
  if not pose then return legs.stand(m, s) end
  local ball = game.ball(m, s, pose)
  note_kick_off(m, s, ball)
  m.vars.can = { pass = P.passes > 0.5, dribble = P.dribbles > 0.5, support = P.supports > 0.5, dive = P.dives > 0.5 }
  m.vars.lies = legs.lies(m)
  kicks.look(m, s, pose)
  m.vars.role = roles.pick(m, s, pose, ball)
  tell(m, s, pose, ball)
  plays[m.vars.role](m, s, pose, ball)
end

local function stand(m, s)
  game.listen(m, s)
  legs.stand(m, s)
end

local function go_to_place(m, s)
  game.listen(m, s)
  local pose = field.pose(s)
  m.vars.kick_off_ours = false
  if pose then ready.play(m, s, pose) else legs.stand(m, s) end
end

local function is(phase) return function(s, m) return game.phase(s, m) == phase end end
local function is_not(phase) return function(s, m) return game.phase(s, m) ~= phase end end

return k.decisions "team" {
  vars = {
    mates = {}, others = {}, rolling = {}, can = {}, heard = false, lies = false, role = "none", kick = false,
    told_s = -10, told_role = "none", told_pass = false,
    whistled = false, whistles = 0, kick_off_ours = false, kick_off_theirs = false,
  },
  initial = "wait",
  always  = { { on = "robot.tell", action = hear } },

  k.state "wait" {
    during = stand,
    { when = is "ready", to = "ready" },
    { when = is "play", to = "play" },
    endless = true,
  },
  k.state "ready" {
    during = go_to_place,
    { when = is_not "ready", to = "wait" },
  },
  k.state "play" {
    during = play,
    { when = is_not "play", to = "wait" },
  },
}

-- A football team of two, three or four: what each robot decides, 20 times a second. The plays stand in files of their
-- own: ready, striker, supporter, keeper, search. What the robot knows is in s.seen (docs/football.md), what it does are
-- orders to `footwork`, and robot.tell is what it says to its mates.
local k = require "kadans"
local field = require "field"
local game = require "game"
local keeper = require "keeper"
local kicks = require "kicks"
local legs = require "legs"
local radio = require "radio"
local ready = require "ready"
local roles = require "roles"
local striker = require "striker"
local supporter = require "supporter"

local P = k.params {
  tell_s = { 1, min = 0.1, max = 60, unit = "s", doc = "how often it tells its mates when nothing says when it is worth it" },
  passes = { 1, min = 0, max = 1, doc = "0: it never passes to a mate" },
  dribbles = { 1, min = 0, max = 1, doc = "0: it does without short kicks ahead" },
  supports = { 1, min = 0, max = 1, doc = "0: a supporter stands where it is" },
  dives  = { 1, min = 0, max = 1, doc = "0: the keeper stays on its feet" },
}

local events = { ["robot.tell"] = radio.tells }
for name, order in pairs(require "foot_orders") do events[name] = order end
k.events(events)

local plays = { striker = striker.play, supporter = supporter.play, keeper = keeper.play }

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
  m.vars.saves = game.saves(s)
  m.vars.can = {
    pass = P.passes > 0.5, dribble = P.dribbles > 0.5, support = P.supports > 0.5 and not m.vars.saves, dive = P.dives > 0.5,
  }
  m.vars.lies = legs.lies(m)
  kicks.look(m, s, pose)
  m.vars.leaves_ball = game.leaves_ball(m, s, pose, ball)
  m.vars.role = roles.pick(m, s, pose, ball)
  radio.tell(m, s, pose, ball, P.tell_s)
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
    takes = false, took_s = false, leaves_ball = false, saves = false,
    told_s = -10, told_say = 0, told_role = "none", told_pass = false,
    whistled = false, whistles = 0, kick_off_ours = false, kick_off_theirs = false,
  },
  initial = "wait",
  always  = { { on = "robot.tell", action = radio.hear } },

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

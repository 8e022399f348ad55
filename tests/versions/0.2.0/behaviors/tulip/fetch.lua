-- Decisions, one level above behaviors: stands until a ball lies still, walks to it, and waves. docs/supervisor.md tells how
-- decisions work.
local k = require "kadans"
local floor = require "floor"

local P = k.params {
  near_m  = { 0.6, min = 0.3, max = 3, unit = "m", doc = "how near it goes to the ball" },
  fresh_s = { 0.5, min = 0.2, max = 10, unit = "s", doc = "a ball that was not seen for so long is lost" },
  still_m = { 0.25, min = 0.02, max = 2, unit = "m", doc = "a ball that is seen farther off than that rolls" },
  still_s = { 1.0, min = 0.1, max = 10, unit = "s", doc = "how long it must lie still" },
}

local function sees(s)
  local ball = s.seen.ball
  return ball.confidence > 0.5 and ball.age_s < P.fresh_s and ball.carried
end

-- Since when the ball has been where it is, as seen from a robot that stands.
local function watch(m, s)
  local ball, at = s.seen.ball, m.vars.at
  if not sees(s) then m.vars.at = nil return end
  local far_m = at and math.sqrt((ball.x_m - at.x_m) ^ 2 + (ball.y_m - at.y_m) ^ 2)
  if not at or far_m > P.still_m then m.vars.at = { x_m = ball.x_m, y_m = ball.y_m, since_s = s.time_s } end
end

local function lies_still(s, m) return m.vars.at ~= nil and s.time_s - m.vars.at.since_s > P.still_s end

-- The place before the ball, as seen from the robot, and the way it looks there.
local function before(ball)
  local share = math.max(0, 1 - P.near_m / math.sqrt(ball.x_m ^ 2 + ball.y_m ^ 2))
  return { x_m = share * ball.x_m, y_m = share * ball.y_m, heading_rad = math.atan2(ball.y_m, ball.x_m) }
end

local function lies(s) return floor.lies(s.base) end

return k.decisions "fetch" {
  vars    = {},
  initial = "search",

  k.state "search" {
    enter = function(m)
      m.vars.at = nil
      m:replace("stand")
    end,
    during = watch,
    { when = lies, to = "fallen", why = "lies" },
    { when = lies_still, to = "go" },
  },
  k.state "go" {
    enter = function(m, s) m:replace("walk_to", before(s.seen.ball)) end,
    { when = lies, to = "fallen", why = "lies" },
    { on = "play.done", to = "greet" },
    { on = "play.*", to = "search", why = "could not go there" },
  },
  k.state "greet" {
    enter = function(m) m:replace("wave") end,
    { when = lies, to = "fallen", why = "lies" },
    { on = "play.*", to = "over" },
  },
  k.state "fallen" {
    enter = function(m) m:replace("get_up") end,
    { on = "play.*", to = "search" },
  },
  k.final "over" { outcome = "done" },
}

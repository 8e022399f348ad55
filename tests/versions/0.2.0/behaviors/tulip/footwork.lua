-- Walks to places and kicks the ball as somebody decides from moment to moment: the decisions of a football team, over
-- the events below. Places are as the robot sees them when the event comes, x ahead and y to the left. An order holds
-- until the next one; without one for a while the robot comes to stand. When it falls, or threw itself to a side, it gets up.
local k = require "kadans"
local ball = require "ball"
local dribble = require "dribbling"
local floor = require "floor"
local orders = require "foot_orders"
local walk = require "walking"

local P = k.params {
  settle_s   = { 0.8, min = 0.1, max = 10, unit = "s", doc = "time to take the pose" },
  patience_s = { 1, min = 0.1, max = 60, unit = "s", doc = "without a word of who decides, after which it stands" },
  roll_m_s2  = { 0.28, min = 0.01, max = 5, unit = "m/s2", doc = "how the ground slows a ball" },
  most_m_s   = { 0.5, min = 0.05, max = 0.6, unit = "m/s", doc = "how fast it walks to the ball" },
  after_s    = { 0.6, min = 0, max = 10, unit = "s", doc = "time in place after a kick" },
}

k.events(orders)

-- A place that is given from where the robot is, in the frame of walk.at.
local function from_here(m, data)
  local at = walk.at(m)
  local x_m, y_m = walk.seen_from(at, data.x_m, data.y_m)
  return { x_m = x_m, y_m = y_m, heading_rad = walk.angle(at.heading_rad + (data.heading_rad or 0)) }
end

-- Whatever it does just now; what the order means from where the robot is, is reckoned when its legs are its own.
local function hear(m, s)
  m.vars.order = { what = s.event.name, data = s.event.data or {}, heard_s = s.time_s }
end

local function take(m, order)
  if not order.taken and order.data.x_m then order.place = from_here(m, order.data) end
  order.taken = true
end

-- The same place does not make it walk again for what odometry and noise say.
local function go(m, order)
  local at = walk.at(m)
  local off_m = walk.distance(order.place, at)
  local off_rad = math.abs(walk.angle(order.place.heading_rad - at.heading_rad))
  if walk.stands(m) and off_m < 0.25 and off_rad < 0.35 then return end
  if walk.to(m, order.place, { m = 0.1, rad = 0.15 }, order.data.most_m_s or P.most_m_s) then walk.stop(m) end
end

-- A joint that was knocked faster than its drive is damped from then on, until somebody clears the fault.
local function clear(m, s)
  local level = s.safety.level
  if level == "normal" or level == "limited" then m.vars.sound_s = s.time_s end
  if s.time_s - m.vars.sound_s < 0.5 then return end
  m.vars.sound_s = s.time_s
  m:clear_faults()
end

-- The ball is followed anew for each order: what was seen before it may be of another place.
local function dribbles(m, s, order)
  local v = m.vars
  if not v.dribbled then dribble.begin(m, v.kept) end
  v.dribbled, v.armed = v.dribbled or {}, false
  local b = dribble.watch(m, s, v.dribbled, P.roll_m_s2)
  if not b then return end
  local rad = math.atan2(order.place.y_m - b.y_m, order.place.x_m - b.x_m)
  dribble.along(m, b, { x_m = b.x_m, y_m = b.y_m, rad = rad }, order.data.most_m_s or P.most_m_s, 1)
end

local function end_dribble(m)
  if m.vars.dribbled then dribble.finish(m, m.vars.kept) end
  m.vars.dribbled = false
end

-- Takes the kick back: that it is not to kick any more does not mean that it has kicked.
local function keep(m)
  walk.keep(m)
  m.vars.armed = false
end

local leans_rad = 0.4  -- from which on it leans on something
local function obey(m, s)
  clear(m, s)
  if s.base.tilt_rad < leans_rad then m.vars.upright_s = s.time_s end
  local order = m.vars.order
  if order then take(m, order) end
  local b = ball.watch(m, s, m.vars.known)
  local kicks = walk.kicks(m)
  if m.vars.armed and not kicks then m.vars.kicked_s = s.time_s end
  m.vars.armed = kicks
  local heard = order and s.time_s - order.heard_s <= P.patience_s
  if heard and order.what == "foot.dribble" then return dribbles(m, s, order) end
  end_dribble(m)
  if not heard or order.what == "foot.stand" then
    if kicks then keep(m) end
    walk.stop(m)
  elseif s.time_s - m.vars.kicked_s < P.after_s then
    walk.go(m, {})
  elseif order.what == "foot.turn" then
    if kicks then keep(m) end
    walk.go(m, { turn_rad_s = order.data.rad_s })
  elseif order.what == "foot.go" then
    if kicks then keep(m) end
    go(m, order)
  elseif b and order.what == "foot.kick" then
    if not ball.approach(m, b, order.place, order.data.beyond_m or 1, P.roll_m_s2, P.most_m_s, ball.quick) then
      m.vars.armed = false
    end
  end
end

local function lies(s) return floor.lies(s.base) end

-- It leans on something, a goal's net for example: too far to walk, not far enough to lie. Then it lets itself fall to
-- the side to which it leans, and gets up.
local leans_s = 1
local function leans(side)
  return function(s, m)
    return s.time_s - m.vars.upright_s > leans_s and (s.base.roll_rad < 0) == (side == "left")
  end
end

local function dives(side)
  return function(_, m)
    local order = m.vars.order
    return order ~= nil and order.what == "foot.dive" and (order.data.left > 0.5) == (side == "left")
  end
end

local function let_go(m)
  end_dribble(m)
  walk.keep(m)
  walk.stop(m)
  m.vars.known, m.vars.order, m.vars.armed = {}, nil, false
end

return k.behavior "footwork" {
  controls = "walking",
  vars     = { known = {}, kept = {}, dribbled = false, side = 1, armed = false,
               kicked_s = -10, sound_s = 0, upright_s = 0 },
  initial  = "set_out",
  always   = { { on = "foot.*", action = hear } },

  k.state "set_out" {
    run = function(m) walk.set_out(m, P.settle_s) end,
    { on = "run.done", to = "obeys" },
    { when = lies, to = "fallen", why = "lies" },
  },
  k.state "obeys" {
    endless = true,
    enter = function(m, s) m.vars.upright_s = s.time_s end,
    during = obey,
    { when = lies, to = "fallen", why = "lies" },
    { when = dives "left", to = "dive_left" },
    { when = dives "right", to = "dive_right" },
    { when = leans "left", to = "dive_left", why = "leans on something" },
    { when = leans "right", to = "dive_right", why = "leans on something" },
  },
  k.state "dive_left" {
    enter = let_go,
    k.call "dive" { left = 1 },
    { on = { "done", "failed" }, to = "fallen" },
  },
  k.state "dive_right" {
    enter = let_go,
    k.call "dive" { left = 0 },
    { on = { "done", "failed" }, to = "fallen" },
  },
  k.state "fallen" {
    enter = let_go,
    k.call "get_up",
    { on = "done", to = "set_out" },
    { on = "failed", to = "fallen", why = "tries again" },
  },
}

-- Words for walking: what a behavior asks of the control object "walk". What the robot cannot do is refused with a
-- sentence, and nothing is clamped.
local walk = {}

-- An angle as what is turned by it, from -pi to pi; a value as far as this bound allows.
local function angle(rad) return math.atan2(math.sin(rad), math.cos(rad)) end
local function within(value, most) return math.max(-most, math.min(most, value)) end
walk.angle, walk.within = angle, within

-- What is x_m ahead of `at` and y_m to the left of it, in the frame of `at`; and a place of that frame, as it is seen from
-- `at`. Both return two numbers.
function walk.seen_from(at, x_m, y_m)
  local c, n = math.cos(at.heading_rad), math.sin(at.heading_rad)
  return at.x_m + c * x_m - n * y_m, at.y_m + n * x_m + c * y_m
end
function walk.as_seen(at, place)
  local c, n = math.cos(at.heading_rad), math.sin(at.heading_rad)
  local x_m, y_m = place.x_m - at.x_m, place.y_m - at.y_m
  return c * x_m + n * y_m, c * y_m - n * x_m
end

function walk.distance(a, b) return math.sqrt((a.x_m - b.x_m) ^ 2 + (a.y_m - b.y_m) ^ 2) end

-- The fastest that it walks, alone: together the shares of these may not exceed 1.5.
local fastest = { forward_m_s = 0.6, backward_m_s = 0.2, left_m_s = 0.15, turn_rad_s = 0.8 }

local function shares(way)
  local forward = way.forward_m_s or 0
  return {
    forward_m_s = math.abs(forward) / (forward < 0 and fastest.backward_m_s or fastest.forward_m_s),
    left_m_s = math.abs(way.left_m_s or 0) / fastest.left_m_s,
    turn_rad_s = math.abs(way.turn_rad_s or 0) / fastest.turn_rad_s,
  }
end

-- Takes the pose from which it sets out; in `run` only.
function walk.set_out(m, settle_s)
  m.posture:set_gains("stiff")
  m.posture:move("set_out", { time_s = settle_s })
  m:wait(settle_s)
end

-- The velocity at which it goes when something sets `go`, a reflex for example; what is left out is 0.
function walk.meant(m, way)
  m.walk:set("forward_m_s", way.forward_m_s or 0)
  m.walk:set("left_m_s", way.left_m_s or 0)
  m.walk:set("turn_rad_s", way.turn_rad_s or 0)
end

-- Walks at { forward_m_s =, left_m_s =, turn_rad_s = } from now on; what is left out is 0. True, or nil and a sentence.
function walk.go(m, way)
  local together = 0
  for name, share in pairs(shares(way)) do
    if not (share <= 1) then
      return nil, string.format("%s = %g is faster than it walks", name, way[name])
    end
    together = together + share
  end
  if together > 1.5 then return nil, string.format("it does not walk so fast in all directions at once: %.1f of 1.5", together) end
  walk.meant(m, way)
  m.walk:set("go", 1)
  return true
end

-- The same way, slowed as a whole to what walk.go takes: what a person's stick asks for, which says a direction.
function walk.slowed(way)
  local most, together = 0, 0
  for _, share in pairs(shares(way)) do most, together = math.max(most, share), together + share end
  local scale = math.min(1, (1 - 1e-9) / most, (1.5 - 1e-9) / together)
  local slowed = {}
  for name, value in pairs(way) do slowed[name] = scale * value end
  return slowed
end

-- Comes to stand.
function walk.stop(m) m.walk:set("go", 0) end

-- Whether it stands.
function walk.stands(m) return m.walk:setpoint("go") < 0.5 end

-- Where it is by its steps, { x_m =, y_m =, heading_rad = }, since the start or since walk.here.
function walk.at(m)
  return { x_m = m.walk:setpoint("x_m"), y_m = m.walk:setpoint("y_m"), heading_rad = m.walk:setpoint("heading_rad") }
end

-- Says where it is.
function walk.here(m, place)
  m.walk:set("x_m", place.x_m or 0)
  m.walk:set("y_m", place.y_m or 0)
  m.walk:set("heading_rad", place.heading_rad or 0)
end

-- What the kick can do: a ball that the foot meets at f m/s slides, then rolls at 0.71 f.
-- The tip of the foot is foot_m behind the ball's middle, its frame before_m before the base's and beside_m beside it.
local kick = { near_m = 0.3, far_m = 4.5, rad = 0.55, rolls = 0.71, foot_max_m_s = 2.8 }
kick.foot_m, kick.before_m, kick.beside_m = 0.235, 0.07, 0.09

-- Kicks the ball at { x_m =, y_m = }, in the frame of walk.at, toward rad, so that it rolls far_m on a ground that slows
-- it by roll_m_s2 (0.28). The object kicks within a step, as soon as its steps bring a foot to the ball. To be called
-- again when the ball is seen better. True, or nil and a sentence.
function walk.kick(m, ball, rad, far_m, roll_m_s2)
  local turned = angle(rad - walk.at(m).heading_rad)
  if not (math.abs(turned) <= kick.rad) then
    return nil, string.format("it does not kick %.2f rad to the side, at most %.2f", turned, kick.rad)
  end
  if not (far_m >= kick.near_m and far_m <= kick.far_m) then
    return nil, string.format("it does not kick a ball %g m far, but %g to %g", far_m, kick.near_m, kick.far_m)
  end
  m.walk:set("kick_x_m", ball.x_m)
  m.walk:set("kick_y_m", ball.y_m)
  m.walk:set("kick_rad", angle(rad))
  if m.walk:setpoint("kick_m_s") > 0 then return true end
  m.walk:set("kick_m_s", math.min(kick.foot_max_m_s, math.sqrt(2 * (roll_m_s2 or 0.28) * far_m) / kick.rolls))
  return true
end

-- Whether it still is to kick; not in the tick of walk.kick. walk.keep takes the kick back.
function walk.kicks(m) return m.walk:setpoint("kick_m_s") > 0 end
function walk.keep(m) m.walk:set("kick_m_s", 0) end

-- In each tick: a step of the way to { x_m =, y_m =, heading_rad = }; true when it is there. It turns toward a place that is far,
-- walks there, at most at most_m_s (0.3), and turns as it shall stand.
function walk.to(m, goal, near, most_m_s)
  near = near or { m = 0.05, rad = 0.1 }
  local at = walk.at(m)
  local x_m, y_m = goal.x_m - at.x_m, goal.y_m - at.y_m
  local far_m = math.sqrt(x_m ^ 2 + y_m ^ 2)
  local wanted_rad = far_m > 0.5 and math.atan2(y_m, x_m) or (goal.heading_rad or at.heading_rad)
  local turn_rad = angle(wanted_rad - at.heading_rad)
  if far_m < near.m and math.abs(turn_rad) < near.rad then return true end
  local ahead_m, left_m = walk.as_seen(at, goal)
  local facing = math.max(0, math.cos(turn_rad)) ^ 2
  walk.go(m, walk.slowed {
    forward_m_s = math.max(-0.1, within(0.8 * ahead_m, most_m_s or 0.3) * facing),
    left_m_s = within(0.6 * left_m, 0.06),
    turn_rad_s = within(1.2 * turn_rad, 0.4),
  })
  return false
end

-- Where it stands best to kick this ball toward rad, with the left foot (side 1) or the right one (-1), when it faces
-- heading_rad.
function walk.to_kick(ball, rad, side, heading_rad)
  local c, n = math.cos(heading_rad), math.sin(heading_rad)
  local x_m = ball.x_m - kick.foot_m * math.cos(rad) - kick.before_m * c + side * kick.beside_m * n
  local y_m = ball.y_m - kick.foot_m * math.sin(rad) - kick.before_m * n - side * kick.beside_m * c
  return { x_m = x_m, y_m = y_m, heading_rad = heading_rad }
end

-- In each tick: a step of the way to a place that is near, without turning away from the heading there. Returns how far
-- it is.
function walk.beside(m, place)
  local at = walk.at(m)
  local ahead_m, left_m = walk.as_seen(at, place)
  walk.go(m, walk.slowed {
    forward_m_s = math.max(-0.15, math.min(0.25, 0.9 * ahead_m)),
    left_m_s = within(1.2 * left_m, 0.12),
    turn_rad_s = within(1.5 * angle(place.heading_rad - at.heading_rad), 0.5),
  })
  return walk.distance(place, at)
end

return walk

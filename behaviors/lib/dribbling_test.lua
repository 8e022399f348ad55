local dribble = require "dribbling"

-- A robot that stands at the origin, whose walk keeps its set-points and parameters, and a camera.
local function stage()
  local points = { x_m = 0, y_m = 0, heading_rad = 0, go = 0, kick_m_s = 0 }
  local parameters = { ["kick.near_m"] = -0.04, ["kick.far_m"] = 0.15, early_share = 0.6, apart_max_m = 0.36 }
  local object = {
    set = function(_, name, value) points[name] = value end,
    setpoint = function(_, name) return points[name] end,
    parameter = function(_, name) return parameters[name] end,
    set_parameter = function(_, name, value) parameters[name] = value end,
  }
  local m = { walk = object, vars = { side = 1 } }
  local s = { time_s = 0, seen = { ball = { confidence = 0 } } }
  local function see(x_m, y_m, age_s) s.seen.ball = { confidence = 1, age_s = age_s, x_m = x_m, y_m = y_m } end
  return m, s, see, points, parameters
end

local ahead = { x_m = 0, y_m = 0, rad = 0 }

describe("dribbling", function()
  it("follows a ball that rolls, from late pictures, and lets it come to rest without any", function()
    local m, s, see = stage()
    local known = {}
    for tick = 1, 200 do
      s.time_s = 0.01 * tick
      if tick % 7 == 0 then see(1 + 0.5 * (s.time_s - 0.1), 0.2, 0.1) else s.seen.ball.age_s = (s.seen.ball.age_s or 0) + 0.01 end
      dribble.watch(m, s, known, 0)
    end
    expect(known.x_m).to_be_near(1 + 0.5 * s.time_s, 0.03)
    expect(known.x_m_s).to_be_near(0.5, 0.06)
    for _ = 1, 300 do
      s.time_s = s.time_s + 0.01
      s.seen.ball.age_s = s.seen.ball.age_s + 0.01
      dribble.watch(m, s, known, 0.25)
    end
    expect(known.x_m_s).to_equal(0)
    expect(known.x_m).to_be_near(2 + 0.5 * 0.5 ^ 2 / 0.25, 0.1)
  end)

  it("takes a ball elsewhere only when two pictures say so", function()
    local m, s, see = stage()
    local known = {}
    for i, x_m in ipairs { 1, 3, 3 } do
      s.time_s = 0.1 * i
      see(x_m, 0, 0)
      dribble.watch(m, s, known, 0.28)
      expect(known.x_m).to_be_near(i < 3 and 1 or 3, 1e-9)
    end
  end)

  it("walks to a ball that is far, and asks for the kick when it is near", function()
    local m, _, _, points = stage()
    local b = { x_m = 1.5, y_m = 0.09, x_m_s = 0, y_m_s = 0 }
    dribble.along(m, b, ahead, 0.4, 1.5)
    expect(points.forward_m_s).to_be_near(0.4, 1e-9)
    expect(points.kick_m_s).to_equal(0)
    b.x_m = 0.35
    dribble.along(m, b, ahead, 0.4, 1.5)
    expect(points.kick_m_s).to_be_above(1)
    expect(points.kick_x_m).to_equal(0.35)
    expect(points.kick_rad).to_be_below(0)  -- back to its line, on the right
  end)

  it("slows while the ball is not before a foot, and goes around one that is behind", function()
    local m, _, _, points = stage()
    dribble.along(m, { x_m = 0.4, y_m = 0.3, x_m_s = 0, y_m_s = 0 }, ahead, 0.4, 1.5)
    expect(points.forward_m_s).to_be_below(0.1)
    expect(points.left_m_s).to_be_above(0.05)
    dribble.along(m, { x_m = -0.5, y_m = 0, x_m_s = 0, y_m_s = 0 }, ahead, 0.4, 1.5)
    expect(points.kick_m_s).to_equal(0)
    expect(math.abs(points.turn_rad_s)).to_be_above(0.3)
  end)

  it("knows that it kicked before it sees it", function()
    local m, _, _, points = stage()
    local b = { x_m = 0.35, y_m = 0.09, x_m_s = 0, y_m_s = 0 }
    dribble.along(m, b, ahead, 0.4, 1.5)
    dribble.along(m, b, ahead, 0.4, 1.5)
    points.kick_m_s = 0
    dribble.along(m, b, ahead, 0.4, 1.5)
    expect(b.x_m_s).to_be_above(0.8)
  end)

  it("leaves the walk as it was", function()
    local m, _, _, points, parameters = stage()
    local kept = {}
    dribble.begin(m, kept)
    dribble.begin(m, kept)
    expect(parameters.early_share).to_be_near(0.85, 1e-9)
    points.kick_m_s = 1
    dribble.finish(m, kept)
    expect(parameters).to_equal { ["kick.near_m"] = -0.04, ["kick.far_m"] = 0.15, early_share = 0.6, apart_max_m = 0.36 }
    expect(points.kick_m_s).to_equal(0)
  end)
end)

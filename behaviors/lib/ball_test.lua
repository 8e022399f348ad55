local ball = require "ball"

-- A robot that turns on the spot, and a camera whose pictures arrive late.
local function stage()
  local at = { x_m = 1, y_m = 2, heading_rad = 0 }
  local m = { walk = { setpoint = function(_, name) return at[name] end } }
  local s = { time_s = 0, seen = { ball = { confidence = 0 } } }
  return m, s, at
end

describe("ball", function()
  it("knows nothing before the ball was seen", function()
    local m, s = stage()
    expect(ball.watch(m, s, {})).to_equal(nil)
  end)

  it("puts a late picture where the robot was then", function()
    local m, s, at = stage()
    local known = {}
    for tick = 0, 30 do
      s.time_s, at.heading_rad = 0.01 * tick, 0.02 * tick
      local taken_rad = at.heading_rad - 0.2  -- 0.1 s before
      if tick >= 10 then
        s.seen.ball = { confidence = 1, age_s = 0.1, x_m = 2 * math.cos(-taken_rad), y_m = 2 * math.sin(-taken_rad) }
        ball.watch(m, s, known)
      else
        ball.watch(m, s, known)
      end
    end
    expect(known.x_m).to_be_near(3, 1e-9)
    expect(known.y_m).to_be_near(2, 1e-9)
    expect(known.seen_s).to_be_near(0.2, 1e-9)
  end)

  it("takes the mean of pictures, and a ball elsewhere only when two pictures say so", function()
    local m, s = stage()
    local known = {}
    local function picture(x_m)
      s.time_s = s.time_s + 0.1
      s.seen.ball = { confidence = 1, age_s = 0, x_m = x_m, y_m = 0 }
      return ball.watch(m, s, known).x_m
    end
    expect(picture(1)).to_be_near(2, 1e-9)
    expect(picture(1.2)).to_be_near(2.05, 1e-9)
    expect(picture(3)).to_be_near(2.05, 1e-9)
    expect(picture(3)).to_be_near(4, 1e-9)
  end)

  it("says whether it is behind the ball, and takes a kick back where it is not", function()
    local m, _, at = stage()
    local b, target = { x_m = 1.5, y_m = 2 }, { x_m = 5, y_m = 2 }
    m.vars = { side = 1 }
    m.walk.set = function(_, name, value) at[name] = value end
    at.kick_m_s = 0
    at.x_m, at.y_m = 1.2, 2.09
    expect(ball.approach(m, b, target, 1, 0.28)).to_be_true()
    expect(at.kick_m_s).to_be_above(0)
    at.x_m, at.y_m = 1.9, 2.5  -- the ball is behind it
    expect(ball.approach(m, b, target, 1, 0.28)).to_be_false()
    expect(at.kick_m_s).to_equal(0)
  end)
end)

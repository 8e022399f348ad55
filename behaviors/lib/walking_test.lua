local walk = require "walking"

-- A robot that does what it is told at once: its walk keeps its set-points.
local function robot()
  local points = { x_m = 0, y_m = 0, heading_rad = 0, go = 0 }
  local object = {
    set = function(_, name, value) points[name] = value end,
    setpoint = function(_, name) return points[name] end,
  }
  return { walk = object }, points
end

describe("walking", function()
  it("goes at what is asked for, and leaves out what is not", function()
    local m, points = robot()
    expect(walk.go(m, { forward_m_s = 0.3 })).to_equal(true)
    expect(points.forward_m_s).to_equal(0.3)
    expect(points.left_m_s).to_equal(0)
    expect(points.go).to_equal(1)
    walk.stop(m)
    expect(walk.stands(m)).to_equal(true)
  end)

  it("refuses with a sentence what is too fast, alone or together, and changes nothing", function()
    local m, points = robot()
    local goes, why = walk.go(m, { forward_m_s = -0.3 })
    expect(goes).to_equal(nil)
    expect(why).to_contain "forward_m_s = -0.3 is faster"
    goes, why = walk.go(m, { forward_m_s = 0.5, left_m_s = 0.14, turn_rad_s = 0.7 })
    expect(goes).to_equal(nil)
    expect(why).to_contain "in all directions at once"
    expect(points.go).to_equal(0)
  end)

  it("slows what a stick asks for, in whichever corner, to a way that is never refused, of the same direction", function()
    local m, points = robot()
    for _, x in ipairs { -1, -0.3, 0, 1 } do
      for _, y in ipairs { -1, -0.7, 0, 0.999, 1 } do
        for _, twist in ipairs { -1, 0, 0.5, 1 } do
          local way = { forward_m_s = y * (y < 0 and 0.2 or 0.6), left_m_s = -0.15 * x, turn_rad_s = -0.8 * twist }
          expect(walk.go(m, walk.slowed(way))).to_equal(true)
          expect(points.forward_m_s * way.turn_rad_s).to_be_near(points.turn_rad_s * way.forward_m_s, 1e-9)
          expect(points.forward_m_s * way.left_m_s).to_be_near(points.left_m_s * way.forward_m_s, 1e-9)
        end
      end
    end
    expect(walk.slowed({ forward_m_s = 0.3 }).forward_m_s).to_equal(0.3)
    expect(walk.slowed({ forward_m_s = -0.4 }).forward_m_s).to_be_near(-0.2, 1e-6)
  end)

  it("kicks as hard as the way asks for, and says what it does not do and then changes nothing", function()
    local m, points = robot()
    points.kick_m_s = 0
    expect(walk.kick(m, { x_m = 0.3, y_m = 0.1 }, 0.2, 3, 0.28)).to_equal(true)
    expect(points.kick_x_m).to_equal(0.3)
    expect(points.kick_rad).to_be_near(0.2, 1e-9)
    expect((0.71 * points.kick_m_s) ^ 2 / (2 * 0.28)).to_be_near(3, 1e-9)
    expect(walk.kicks(m)).to_equal(true)
    points.heading_rad = 1
    local kicks, why = walk.kick(m, { x_m = 0.5, y_m = 0.1 }, 0.2, 3)
    expect(kicks).to_equal(nil)
    expect(why).to_contain "-0.80 rad to the side"
    kicks, why = walk.kick(m, { x_m = 0.5, y_m = 0.1 }, 1, 9)
    expect(kicks).to_equal(nil)
    expect(why).to_contain "a ball 9 m far"
    expect(points.kick_x_m).to_equal(0.3)
    walk.keep(m)
    expect(walk.kicks(m)).to_equal(false)
  end)

  it("walks to a place behind and to the left, and turns there as it shall", function()
    local m, points = robot()
    local dt_s, there = 0.01, false
    for _ = 1, 6000 do
      there = walk.to(m, { x_m = -1, y_m = 0.7, heading_rad = 1 })
      if there then break end
      local c, n = math.cos(points.heading_rad), math.sin(points.heading_rad)
      points.x_m = points.x_m + dt_s * (c * points.forward_m_s - n * points.left_m_s)
      points.y_m = points.y_m + dt_s * (n * points.forward_m_s + c * points.left_m_s)
      points.heading_rad = points.heading_rad + dt_s * points.turn_rad_s
    end
    expect(there).to_equal(true)
    expect(points.x_m).to_be_near(-1, 0.06)
    expect(points.y_m).to_be_near(0.7, 0.06)
    expect(points.heading_rad).to_be_near(1, 0.12)
  end)
end)

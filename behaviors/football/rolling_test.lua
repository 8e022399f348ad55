-- kadans behavior test behaviors/football/rolling_test.lua
local rolling = require "rolling"

local pose = { x_m = 0, y_m = 0, heading_rad = 0 }
local function watch(known, time_s, x_m, y_m)
  return rolling.watch(known, { time_s = time_s, seen = { ball = { confidence = 1, age_s = 0.06, carried = true, x_m = x_m, y_m = y_m } } }, pose)
end

describe("rolling", function()
  it("tells how a ball rolls, and that one rests", function()
    local known, ball = {}, nil
    for i = 0, 6 do ball = watch(known, i / 15, 3 - 1.5 * i / 15, 0.3 * i / 15) end
    expect(ball.rolls.x_m_s).to_be_near(-1.5, 1e-6)
    expect(ball.rolls.y_m_s).to_be_near(0.3, 1e-6)
    known = {}
    for i = 0, 6 do ball = watch(known, i / 15, 3 + 0.01 * (i % 2), 0) end
    expect(ball.rolls).to_be_nil()
  end)

  it("does not take a picture of a ball that is not there for the ball", function()
    local known, ball = {}, nil
    for i = 0, 6 do
      ball = watch(known, i / 15, i == 4 and 1 or 3, 0)
      if i == 0 then expect(ball).to_be_nil() else expect(ball.x_m).to_be_near(3, 1e-9) end
    end
    expect(ball.rolls).to_be_nil()
  end)

  it("believes a ball that is elsewhere when two pictures say so", function()
    local known, ball = {}, nil
    for i = 0, 6 do ball = watch(known, i / 15, i > 4 and 1 or 3, 0) end
    expect(ball.x_m).to_be_near(1, 1e-9)
  end)

  it("tells of a kick by two pictures, and where it goes", function()
    local known, ball = {}, nil
    for i = 0, 8 do ball = watch(known, i / 15, 3 + 0.02 * (i % 2), 0) end
    expect(ball.kicked).to_be_nil()
    watch(known, 9 / 15, 2.75, 0.1)
    ball = watch(known, 10 / 15, 2.6, 0.16)
    expect(ball.kicked.from.x_m).to_be_near(3, 0.03)
    expect(rolling.heads_for(ball.kicked, 0)).to_be_near(1.2, 0.1)
    expect(rolling.heads_for(ball.kicked, 4)).to_be_nil()
  end)

  it("says where it crosses a line, and when it does not come there", function()
    local rolls = { x_m_s = -1.4, y_m_s = 0.2, m_s = math.sqrt(1.4 ^ 2 + 0.2 ^ 2) }
    local in_s, y_m = rolling.crosses({ x_m = 1.5, y_m = 0 }, rolls, 0)
    expect(in_s).to_be_near(1.22, 0.05)
    expect(y_m).to_be_near(0.214, 1e-3)
    expect(rolling.crosses({ x_m = 6, y_m = 0 }, rolls, 0)).to_be_nil()
    expect(rolling.crosses({ x_m = -1, y_m = 0 }, rolls, 0)).to_be_nil()
    expect(rolling.rest({ x_m = 4, y_m = 0 }, rolls).x_m).to_be_near(4 - 3.535, 0.01)
  end)
end)

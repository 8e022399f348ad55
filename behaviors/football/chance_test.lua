-- kadans behavior test behaviors/football/chance_test.lua
local chance = require "chance"

local me = { length_m = 9, width_m = 6, goal_m = 2.6 }
local function at(x_m, y_m, mate) return { x_m = x_m, y_m = y_m, mate = mate or false } end
local goal = { x_m = 4.9, y_m = 0 }
local function shot(x_m, y_m, robots, indirect)
  local all = { { x_m = x_m - 0.4, y_m = y_m, mate = true, kicks = true } }
  for _, robot in ipairs(robots or {}) do all[#all + 1] = robot end
  return chance.of_kick(me, all, at(x_m, y_m), goal, 1.5, indirect)
end

describe("chance", function()
  it("holds a place for better the nearer and the more open the goal is", function()
    expect(chance.of_place(me, 3, 0)).to_be_above(chance.of_place(me, 0, 0))
    expect(chance.of_place(me, 3, 0)).to_be_above(chance.of_place(me, 4.4, 2.9))
    expect(chance.of_place(me, 0, 0)).to_be_above(chance.of_place(me, -4, 0))
  end)

  it("knows a sure goal, one that a keeper stops, and one that does not count", function()
    expect(shot(3.5, 0)).to_be_near(1, 1e-9)
    expect(shot(3.5, 0, { at(4.3, 0) })).to_be_below(0.7)
    expect(shot(3.5, 0, nil, true)).to_be_below(0.1)
    expect(shot(-3, 0)).to_be_below(0.7)
  end)

  it("never kicks toward the own goal", function()
    local ball = at(-3.8, 0)
    local robots = { { x_m = -3.4, y_m = 0, mate = true, kicks = true } }
    local back = chance.of_kick(me, robots, ball, at(-5, 0), 1, false)
    local ahead = chance.of_kick(me, robots, ball, at(-2.8, 0), 0, false)
    expect(back).to_be_below(-0.9)
    expect(ahead).to_be_above(back + 0.9)
  end)

  it("leaves the ball rather where a mate is than where an opponent is", function()
    local robots = { { x_m = 0, y_m = 0, mate = true, kicks = true }, at(2, 1.5, true), at(2, -1.5, false) }
    local to_mate = chance.of_kick(me, robots, at(0.3, 0), at(2, 1.4), 0, false)
    local to_opponent = chance.of_kick(me, robots, at(0.3, 0), at(2, -1.4), 0, false)
    expect(to_mate).to_be_above(to_opponent + 0.3)
  end)
end)

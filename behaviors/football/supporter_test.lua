-- kadans behavior test behaviors/football/supporter_test.lua
local field = require "field"
local supporter = require "supporter"

local function situation(keeper)
  local me = { number = 2, keeper = keeper, players = 2, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 }
  local told = { confidence = 1, state = 3, set_play = 0, ours = -1, stopped = 0, penalty = 0 }
  return { vars = { others = {}, mates = {} } }, { time_s = 10, seen = { me = me, game = told } }
end
local pose = { x_m = 0, y_m = 1, heading_rad = 0 }

describe("supporter", function()
  it("offers itself ahead of a mate that has the ball", function()
    local m, s = situation(0)
    m.vars.mates[1] = { heard_s = 9.8, plays = true, x_m = 0.6, y_m = 0 }
    m.vars.others = { { x_m = 1.6, y_m = 0 } }
    expect(supporter.place(m, s, pose, { x_m = 1, y_m = 0 }).x_m).to_be_above(2)
  end)

  it("covers its goal when an opponent has the ball", function()
    local m, s = situation(0)
    local ball = { x_m = 0.5, y_m = 1 }
    m.vars.mates[1] = { heard_s = 9.8, plays = true, x_m = 2, y_m = 1 }
    m.vars.others = { { x_m = 0.9, y_m = 1 } }
    expect(supporter.lost(m, s, ball)).to_be_true()
    m.vars.mates[1].x_m = 1.2  -- which fights for it
    expect(supporter.lost(m, s, ball)).to_be_false()
    m.vars.mates[1].x_m = 2
    local place, own = supporter.place(m, s, pose, ball), { x_m = -4.5, y_m = 0 }
    expect(field.distance(place, ball)).to_be_near(0.9, 1e-6)
    expect(field.distance(place, own) + 0.9).to_be_near(field.distance(ball, own), 1e-6)  -- on the line between them
  end)

  it("covers the goal in all of the own half when there is no keeper, and otherwise goes forward sooner", function()
    local m, s = situation(0)
    expect(supporter.place(m, s, pose, { x_m = -1, y_m = 0 }).x_m).to_be_below(-1.8)
    m, s = situation(1)
    expect(supporter.place(m, s, pose, { x_m = -1, y_m = 0 }).x_m).to_be_above(0)
  end)

  it("leaves the line to the goal's middle to the keeper", function()
    local m, s = situation(1)
    local place = supporter.place(m, s, pose, { x_m = -2.5, y_m = 0.5 })
    expect(place.x_m).to_be_below(-3.3)
    expect(place.y_m).to_be_below(0)
  end)
end)

-- kadans behavior test behaviors/football/legs_test.lua
local field = require "field"
local game = require "game"
local legs = require "legs"
local striker = require "striker"

local dead_rad = 0.35  -- footwork does not turn for less

-- A robot that hears its orders.
local function robot()
  return {
    vars = { others = {}, mates = {} },
    plays = function() return "obeys" end,
    emit = function(m, name, data) m.order = { name = name, data = data } end,
  }
end
local function at(time_s, more)
  local none = { confidence = 0 }
  local told = { confidence = 1, state = 3, set_play = 0, ours = -1, stopped = 0, penalty = 0 }
  for name, value in pairs(more or {}) do told[name] = value end
  local me = { number = 2, keeper = 1, players = 2, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 }
  return { time_s = time_s, seen = { game = told, me = me, robot_1 = none, robot_2 = none, robot_3 = none } }
end

-- How far apart the headings are that it is told to take within so many seconds.
local function spread(seconds, orders)
  local m, least, most = robot(), 10, -10
  for time_s = 0, seconds, 0.25 do
    orders(m, at(time_s, { set_play = 6, ours = 0 }))
    if m.order.name == "foot.go" then
      least, most = math.min(least, m.order.data.heading_rad), math.max(most, m.order.data.heading_rad)
    end
  end
  return most - least
end

describe("legs", function()
  it("looks to both sides of the ball where it waits, by more than footwork leaves be", function()
    local pose, ball = { x_m = 0, y_m = 0, heading_rad = 0 }, { x_m = 2, y_m = 0 }
    expect(spread(15, function(m, s) legs.watch(m, s, pose, pose, ball) end)).to_be_above(dead_rad)
  end)

  it("does not freeze while the others have 45 s for their corner, and keeps away", function()
    local ball = { x_m = -4.4, y_m = 2.9 }
    local pose = { x_m = -4.4, y_m = 1.5, heading_rad = 1.57 }
    expect(spread(15, function(m, s) striker.block(m, s, pose, ball) end)).to_be_above(dead_rad)
    local m, s = robot(), at(0, { set_play = 6, ours = 0 })
    expect(game.keeps_away(s)).to_be_true()
    striker.block(m, s, pose, ball)
    local goes = field.from_robot(pose, m.order.data.x_m or 0, m.order.data.y_m or 0)
    expect(field.distance(goes, ball)).to_be_above(0.75)
  end)
end)

-- kadans behavior test behaviors/football/striker_test.lua
local field = require "field"
local striker = require "striker"

local function robot()
  return {
    vars = { others = {}, mates = {}, can = {} },
    plays = function() return "obeys" end,
    emit = function(m, name, data) m.order = { name = name, data = data } end,
  }
end
local none = { confidence = 0 }
local me = { number = 2, keeper = 1, players = 2, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 }
local s = {
  time_s = 10,
  seen = {
    game = { confidence = 1, state = 3, set_play = 0, ours = -1, stopped = 0, penalty = 0 }, me = me,
    robot_1 = none, robot_2 = none, robot_3 = none,
  },
}
local pose = { x_m = -1, y_m = 0.5, heading_rad = 0 }

local function goes(ball)
  local m = robot()
  striker.play(m, s, pose, ball)
  expect(m.order.name).to_equal "foot.go"
  return field.from_robot(pose, m.order.data.x_m, m.order.data.y_m)
end

describe("striker", function()
  it("goes to a ball that a mate sees", function()
    expect(goes({ x_m = 1, y_m = 0.5, own = false }).x_m).to_be_near(1, 1e-9)
  end)

  -- Footwork leaves a place be that is nearer than 0.25 m.
  it("steps back from one before its feet that it does not see itself, and does not stand there", function()
    expect(goes({ x_m = -0.8, y_m = 0.5, own = false }).x_m).to_be_near(-1.45, 1e-9)
    expect(goes({ x_m = -1, y_m = 0.5, own = false }).x_m).to_be_near(-1.45, 1e-9)
  end)
end)

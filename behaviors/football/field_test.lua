-- kadans behavior test behaviors/football/field_test.lua
local field = require "field"

-- What a robot at this pose sees of the field's centre.
local function seen(x_m, y_m, heading_rad)
  local c, n = math.cos(heading_rad), math.sin(heading_rad)
  return { seen = { field = { confidence = 1, known = 1, x_m = -(c * x_m + n * y_m), y_m = n * x_m - c * y_m, heading_rad = -heading_rad } } }
end

describe("field", function()
  it("knows the robot's pose from where the field's centre is", function()
    local pose = field.pose(seen(-2, 1.5, 0.7))
    expect(pose.x_m).to_be_near(-2, 1e-9)
    expect(pose.y_m).to_be_near(1.5, 1e-9)
    expect(pose.heading_rad).to_be_near(0.7, 1e-9)
    expect(pose.known).to_be_true()
    expect(field.pose({ seen = { field = { confidence = 0 } } })).to_be_nil()
  end)

  it("leads from the robot to the field and back", function()
    local pose = { x_m = 1, y_m = -1, heading_rad = 2 }
    local there = field.from_robot(pose, 0.5, 0.25)
    local back = field.to_robot(pose, there)
    expect(back.x_m).to_be_near(0.5, 1e-9)
    expect(back.y_m).to_be_near(0.25, 1e-9)
  end)

  it("leaves a robot in the way to one side, and no other", function()
    local pose, goal = { x_m = 0, y_m = 0, heading_rad = 0 }, { x_m = 3, y_m = 0 }
    local aside = field.around(pose, goal, { { x_m = 0.8, y_m = 0.1 } })
    expect(aside.y_m).to_be_below(-0.5)
    expect(field.around(pose, goal, { { x_m = 0.8, y_m = 1 } })).to_equal(goal)
    expect(field.around(pose, goal, { { x_m = -0.5, y_m = 0 } })).to_equal(goal)
  end)

  it("goes around a goal's post on the field's side, and only around one that is in its way", function()
    local me = { length_m = 9, goal_m = 2.6 }
    local past = field.past_posts(me, { x_m = -4.2, y_m = 2, heading_rad = 0 }, { x_m = -4.3, y_m = 0.6 })
    expect(past.x_m).to_be_near(-3.95, 0.02)
    expect(field.past_posts(me, { x_m = -3.5, y_m = 1.4, heading_rad = 0 }, { x_m = -4, y_m = 1.17 })).to_be_nil()
    expect(field.past_posts(me, { x_m = 4, y_m = 0, heading_rad = 0 }, { x_m = 4.7, y_m = 0 })).to_be_nil()
  end)

  it("comes to any place past the goals' posts, and near none of them", function()
    local me = { length_m = 9, goal_m = 2.6 }
    for from_y_m = -3, 3, 0.25 do
      for _, goal in ipairs { { x_m = -4.2, y_m = 0.5 }, { x_m = -4.3, y_m = 1 }, { x_m = 4.4, y_m = -0.9 }, { x_m = 3.9, y_m = 1.9 } } do
        local pose = { x_m = goal.x_m > 0 and 4 or -4, y_m = from_y_m }
        local steps, nearest_m = 0, math.huge
        while field.distance(goal, pose) > 0.05 and steps < 400 do
          local to = field.past_posts(me, pose, goal) or goal
          local way_m = math.max(field.distance(to, pose), 0.01)
          pose.x_m = pose.x_m + 0.02 * (to.x_m - pose.x_m) / way_m
          pose.y_m = pose.y_m + 0.02 * (to.y_m - pose.y_m) / way_m
          steps = steps + 1
          for _, post_y_m in ipairs { -1.35, 1.35 } do
            nearest_m = math.min(nearest_m, field.distance(pose, { x_m = goal.x_m > 0 and 4.5 or -4.5, y_m = post_y_m }))
          end
        end
        expect(steps).to_be_below(400)
        expect(nearest_m).to_be_above(0.25)
      end
    end
  end)

  it("goes around a place that it shall keep away from, and leaves it first when it is there", function()
    local ball, goal = { x_m = 0, y_m = 0 }, { x_m = -2, y_m = 0 }
    local leaves = field.clear_of({ x_m = 0.5, y_m = 0, heading_rad = 0 }, goal, ball, 1)
    expect(leaves.x_m).to_be_near(1.3, 1e-9)
    local around = field.clear_of({ x_m = 1.4, y_m = 0.1, heading_rad = 0 }, goal, ball, 1)
    expect(math.sqrt(around.x_m ^ 2 + around.y_m ^ 2)).to_be_near(1.3, 1e-9)
    expect(around.y_m).to_be_above(0.8)
    expect(field.clear_of({ x_m = -1.4, y_m = 0.1, heading_rad = 0 }, goal, ball, 1)).to_equal(goal)
    expect(field.clear_of({ x_m = 1.4, y_m = 1.5, heading_rad = 0 }, { x_m = -2, y_m = 1.5 }, ball, 1).y_m).to_equal(1.5)
  end)
end)

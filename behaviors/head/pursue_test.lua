local k = require "kadans"

describe("pursue", function()
  it("keeps both eyes on a target that swings to the left", function()
    local run = k.play("pursue.lua", { robot = "config/head/robot.json" })
    run:advance(2.5)
    local yaw_rad = run.joints.pan.position_rad
    expect(yaw_rad + run.joints.left_eye_pan.position_rad).to_be_near(math.atan2(0.3 - 0.06, 1), 0.06)
    expect(yaw_rad + run.joints.right_eye_pan.position_rad).to_be_near(math.atan2(0.3 + 0.06, 1), 0.06)
    expect(run:finish(10)).to_equal "done"
  end)
end)

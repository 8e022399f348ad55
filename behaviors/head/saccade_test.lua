local k = require "kadans"

describe("saccade", function()
  local run
  before_each(function() run = k.play("saccade.lua", { robot = "config/head/robot.json" }) end)

  it("turns both eyes to the left, the neck after them", function()
    run:advance(1.6)
    local eye_rad = run.joints.left_eye_pan.position_rad
    run:advance(1.2)
    expect(run.joints.pan.position_rad + run.joints.left_eye_pan.position_rad).to_be_near(math.rad(15), 0.06)
    expect(run.joints.pan.position_rad + run.joints.right_eye_pan.position_rad).to_be_near(math.rad(15), 0.1)
    expect(run.joints.pan.position_rad).to_be_above(0.12)
    expect(eye_rad).to_be_above(run.joints.left_eye_pan.position_rad)
  end)

  it("looks at every target and ends", function()
    expect(run:finish(20)).to_equal "done"
  end)
end)

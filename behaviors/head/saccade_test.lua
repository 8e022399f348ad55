local k = require "kadans"

describe("saccade", function()
  local run
  before_each(function() run = k.play("saccade.lua", { robot = "config/head/robot.json" }) end)

  it("turns both eyes to the left, the neck after them", function()
    run:advance(1.6)
    local eye_rad = run.joints.left_eye_pan.position_rad
    run:advance(1.2)
    local left_rad, right_rad = run.joints.left_eye_pan.position_rad, run.joints.right_eye_pan.position_rad
    expect(run.joints.pan.position_rad + (left_rad + right_rad) / 2).to_be_near(math.rad(15), 0.03)
    expect(left_rad - right_rad).to_be_near(-0.12, 0.02)  -- the eyes are 0.12 m apart, the target 1 m away
    expect(run.joints.pan.position_rad).to_be_above(0.12)
    expect(eye_rad).to_be_above(run.joints.left_eye_pan.position_rad)
  end)

  it("looks at every target and ends", function()
    expect(run:finish(20)).to_equal "done"
  end)
end)

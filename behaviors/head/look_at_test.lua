local k = require "kadans"

describe("look_at", function()
  local run
  before_each(function() run = k.play("look_at.lua", { robot = "config/head/robot.json" }) end)

  local function gaze_rad() return run.joints.pan.position_rad + run.joints.left_eye_pan.position_rad end

  it("looks ahead at first, then where its parameters say", function()
    run:advance(0.5)
    expect(gaze_rad()).to_be_near(-0.06, 0.02)
    run:set_parameter("y_m", 0.4)
    run:advance(0.5)
    expect(gaze_rad()).to_be_near(math.atan2(0.4 - 0.06, 1), 0.05)
  end)

  it("leads the target there in the time that it is given", function()
    run:set_parameter("time_s", 2)
    run:set_parameter("y_m", 0.4)
    run:advance(0.5)
    expect(gaze_rad()).to_be_below(0.1)
    run:advance(2)
    expect(gaze_rad()).to_be_near(math.atan2(0.4 - 0.06, 1), 0.05)
  end)
end)

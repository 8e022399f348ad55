local k = require "kadans"

describe("stick", function()
  local run
  before_each(function() run = k.play("stick.lua", { robot = "config/head/robot.json" }) end)

  local function gaze_rad() return run.joints.pan.position_rad + run.joints.left_eye_pan.position_rad end

  it("leads the eyes to where the stick points, and stays when it is let go", function()
    run:set_sensor("joystick.x", -1)
    run:advance(1)
    expect(gaze_rad()).to_be_near(math.atan2(0.4 - 0.06, 1), 0.06)
    run:set_sensor("joystick.x", 0)
    run:advance(0.5)
    local left_rad = gaze_rad()
    run:advance(1)
    expect(gaze_rad()).to_be_near(left_rad, 0.02)
  end)

  it("looks up when the stick points away from the hand", function()
    run:set_sensor("joystick.y", 1)
    run:advance(1)
    expect(run.joints.eye_tilt.position_rad + run.joints.upper_tilt.position_rad + run.joints.lower_tilt.position_rad)
      .to_be_near(-math.atan2(0.4, 1), 0.08)
  end)

  it("stops the target at its bounds", function()
    run:set_parameter("side_m", 0.3)
    run:set_sensor("joystick.x", 1)
    run:advance(3)
    expect(gaze_rad()).to_be_near(-math.atan2(0.36, 1), 0.08)
  end)

  it("brings the target back ahead with the first button", function()
    run:set_sensor("joystick.x", 1)
    run:advance(1)
    run:set_sensor("joystick.x", 0)
    run:set_sensor("joystick.button_1", true)
    run:advance(0.1)
    run:set_sensor("joystick.button_1", false)
    run:advance(1.5)
    expect(gaze_rad()).to_be_near(-0.06, 0.02)
    expect(run.states).to_equal "held back held"
  end)
end)

local k = require "kadans"

local robot = { robot = "config/jiwiy/robot.json" }

describe("stick", function()
  it("changes between a rate, a path and a pose as the buttons say", function()
    local run = k.play("stick.lua", robot)
    run:set_sensor("joystick.x", -1)
    run:advance(0.3)
    expect(run.control_sets).to_equal "velocity"
    expect(run.joints.pan.velocity_rad_s).to_be_near(1.5, 0.1)
    run:set_sensor("joystick.button_3", true)
    run:advance(0.3)
    expect(run.control_sets).to_equal "effort"
    expect(run.joints.pan.velocity_rad_s).to_be_above(1)
    run:set_sensor("joystick.button_3", false)
    run:set_sensor("joystick.button_1", true)
    run:advance(2)
    expect(run.control_sets).to_equal "position"
    expect(run.joints.pan.position_rad).to_be_near(1.2, 0.02)
    expect(run.states).to_equal "velocity effort position"
  end)
end)

-- From its first tick on the stick means what this button says.
local function play(button)
  local run = k.play("stick.lua", robot)
  run:set_sensor("joystick." .. button, true)
  run:advance(0.1)
  run:set_sensor("joystick." .. button, false)
  return run
end

describe("the stick as a rate", function()
  it("turns as fast as the stick says, and rests when it is let go", function()
    local run = play "button_2"
    run:set_sensor("joystick.x", 0.8)
    run:set_sensor("joystick.y", -0.4)
    run:advance(0.4)
    expect(run.joints.pan.velocity_rad_s).to_be_near(-1.2, 0.05)
    expect(run.joints.tilt.velocity_rad_s).to_be_near(0.6, 0.05)
    run:set_sensor("joystick.x", 0)
    run:set_sensor("joystick.y", 0)
    run:advance(0.5)
    expect(run.joints.pan.velocity_rad_s).to_be_near(0, 0.01)
    expect(run.joints.tilt.velocity_rad_s).to_be_near(0, 0.01)
  end)
end)

describe("the stick as a pose", function()
  it("looks where the stick points, and ahead when it is let go", function()
    local run = play "button_1"
    run:set_sensor("joystick.x", -0.5)
    run:set_sensor("joystick.y", 1)
    run:advance(1.5)
    expect(run.joints.pan.position_rad).to_be_near(0.6, 0.01)
    expect(run.joints.tilt.position_rad).to_be_near(-0.6, 0.01)
    run:set_sensor("joystick.x", 0)
    run:advance(1.5)
    expect(run.joints.pan.position_rad).to_be_near(0, 0.01)
  end)
end)

describe("the stick as a path", function()
  it("leads along a path, which ends where the stick is let go", function()
    local run = play "button_3"
    run:set_sensor("joystick.x", -1)
    run:advance(1)
    expect(run.joints.pan.velocity_rad_s).to_be_near(1.5, 0.15)
    local pan_rad = run.joints.pan.position_rad
    expect(pan_rad).to_be_above(0.9)
    run:set_sensor("joystick.x", 0)
    run:advance(1)
    expect(run.joints.pan.velocity_rad_s).to_be_near(0, 0.01)
    expect(run.joints.pan.position_rad).to_be_near(pan_rad + 0.28, 0.06)  -- on which it slows down
  end)

  it("does not lead beyond the end", function()
    local run = play "button_3"
    run:set_sensor("joystick.y", -1)
    run:advance(2)
    expect(run.joints.tilt.position_rad).to_be_near(0.7, 0.01)
  end)
end)

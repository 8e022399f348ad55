-- kadans behavior test behaviors/tulip/stay_up_test.lua
local k = require "kadans"

describe("stay_up", function()
  local run
  before_each(function() run = k.play "stay_up.lua" end)

  local function lies()
    run:set_sensor("base.pitch_rad", 1.5)
    run:set_sensor("base.tilt_rad", 1.5)
    run:set_sensor("feet.left.contact", true)
    run:set_sensor("feet.right.contact", true)
  end
  local function stands()
    run:set_sensor("base.roll_rad", 0)
    run:set_sensor("base.pitch_rad", 0)
    run:set_sensor("base.tilt_rad", 0)
    run:set_sensor("base.height_m", 0.86)
  end

  it("takes a pose that is ready for a push, and stays in it", function()
    run:advance(1)
    expect(run.state).to_equal "stand"
    expect(run.joints.r_hip_roll.position_rad).to_be_near(-0.1, 0.06)
    expect(run.joints.l_hip_roll.position_rad).to_be_near(0.1, 0.06)
    run:advance(20)
    expect(run.state).to_equal "stand"
  end)

  it("does not take a lean for a fall", function()
    run:advance(1)
    run:set_sensor("base.pitch_rad", 0.7)
    run:advance(0.5)
    expect(run.state).to_equal "stand"
  end)

  it("gets up when it lies, and stands its ground again", function()
    run:advance(1)
    lies()
    run:advance(0.1)
    expect(run.state).to_contain "fallen"
    run:advance_to("fallen.get_up.bear")
    run:set_sensor("base.roll_rad", math.pi)
    run:set_sensor("base.pitch_rad", math.pi - 2.1)
    run:advance_to("fallen.get_up.rise")
    run:advance(0.9)
    stands()
    run:advance_to("stand")
    expect(run.states).to_contain "fallen"
    run:advance(1)
    expect(run.joints.l_hip_roll.position_rad).to_be_near(0.15, 0.05)
  end)

  it("gives up when it cannot get up", function()
    run:advance(1)
    lies()
    expect(run:finish(60)).to_equal "failed"
  end)
end)

-- kadans behavior test behaviors/tulip/walk_cycle_test.lua
local k = require "kadans"

describe("walk_cycle", function()
  local run
  before_each(function()
    run = k.play "walk_cycle.lua"
    run:advance_to("left")
  end)

  it("stands on the left leg first, and swings the right one bent", function()
    run:advance(0.15)
    expect(run.control_sets).to_equal "left_stands right_swings arms"
    expect(run.joints.r_knee.position_rad).to_be_above(0.4)
    run:advance(0.3)
    expect(run.joints.r_knee.position_rad).to_be_below(0.35)
  end)

  it("swings the other leg after each landing", function()
    run:emit "landed"
    run:advance(0.1)
    expect(run.state).to_equal "right"
    expect(run.control_sets).to_equal "left_swings right_stands arms"
    run:emit "landed"
    run:advance(0.1)
    expect(run.state).to_equal "left"
  end)

  it("puts its foot ahead and outward when the hips go there", function()
    run:set_sensor("base.pitch_rad", 0.1)
    run:set_sensor("base.roll_rad", 0.1)
    run:advance(0.3)
    local ahead_rad, out_rad = run.joints.r_hip_pitch.position_rad, run.joints.r_hip_roll.position_rad
    run:set_sensor("base.pitch_rad", 0)
    run:set_sensor("base.roll_rad", 0)
    run:advance(0.3)
    expect(run.joints.r_hip_pitch.position_rad).to_be_above(ahead_rad)
    expect(run.joints.r_hip_roll.position_rad).to_be_above(out_rad)
  end)

  it("hands its legs over to dcm_walk after its time, at a landing", function()
    run:set_parameter("for_s", 0)
    run:advance(0.1)
    run:emit "landed"
    run:advance(0.1)
    expect(run.state).to_equal "stop"
    expect(run.control_sets).to_equal "walking"
  end)

  it("gets up when it lies", function()
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
  end)
end)

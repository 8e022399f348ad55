-- kadans behavior test behaviors/reaching/reach_test.lua
local k = require "kadans"

describe("reach", function()
  local run
  before_each(function() run = k.play "reach.lua" end)

  it("sinks first: the knees bend", function()
    run:advance_to("reach")
    expect(run.joints.l_knee.position_rad).to_be_above(0.6)
    expect(run.joints.r_knee.position_rad).to_be_above(0.6)
  end)

  it("stretches the right arm forward, and rises again", function()
    run:advance_to("reach")
    run:advance(3.5)
    expect(run.joints.r_shoulder_pitch.position_rad).to_be_below(-0.8)
    expect(run:finish(30)).to_equal "done"
    expect(run.joints.l_knee.position_rad).to_be_below(0.5)
  end)

  it("says that a hand cannot come to a point 2 m away, and does not move it", function()
    run:set_parameter("forward_m", 2)
    run:advance_to("reach")
    run:advance_to("back")
    expect(run.joints.r_shoulder_pitch.position_rad).to_be_above(-0.4)
    expect(run:finish(30)).to_equal "done"
  end)

  it("gives up when the safety layer takes over", function()
    run:advance_to("shift")
    run:set_sensor("safety.level", "hold")
    run:advance(0.05)
    expect(run.outcome).to_equal "failed"
  end)
end)

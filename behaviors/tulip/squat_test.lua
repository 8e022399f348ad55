-- kadans behavior test behaviors/tulip/squat_test.lua
local k = require "kadans"

describe("squat", function()
  local run
  before_each(function() run = k.play "squat.lua" end)

  it("comes to rest first", function()
    run:advance(1.0)
    expect(run.state).to_equal "settle"
  end)

  it("goes down 0.10 m: the knees bend as far as that takes", function()
    run:advance_to("squat")
    run:advance(1.9)
    expect(run.joints.l_knee.position_rad).to_be_near(1.26364, 0.02)
    expect(run.joints.r_knee.position_rad).to_be_near(run.joints.l_knee.position_rad, 1e-3)
  end)

  it("squats three times and ends standing", function()
    expect(run:finish(30)).to_equal "done"
    expect(run.states).to_equal "settle squat rest squat rest squat rest done"
    expect(run.joints.l_knee.position_rad).to_be_near(0.3, 0.02)
  end)

  it("squats as often as it is told", function()
    run:set_parameter("repeats", 1)
    expect(run:finish(30)).to_equal "done"
    expect(run.states).to_equal "settle squat rest done"
  end)

  it("gives up when the safety layer takes over", function()
    run:advance_to("squat")
    run:set_sensor("safety.level", "hold")
    run:advance(0.05)
    expect(run.outcome).to_equal "failed"
  end)
end)

-- kadans behavior test behaviors/tulip/keep_up_test.lua
local k = require "kadans"

describe("keep_up", function()
  local run
  before_each(function() run = k.play "keep_up.lua" end)

  it("takes a pose with its feet apart", function()
    run:set_parameter("bear_s", 0.5)  -- so that the pose is taken before it gives way to nothing: here is no ground
    run:advance(0.6)
    expect(run.state).to_equal "stand"
    expect(run.joints.l_hip_roll.position_rad).to_be_above(0.1)
  end)

  it("stands on and on", function()
    run:advance(20)
    expect(run.state).to_equal "stand"
  end)

  it("steps when its weight is beyond its soles, and stands as soon as its steps have ended", function()
    run:advance(2)
    run:emit "beyond_its_soles"
    run:advance_to("step")
    run:advance_to("stand")
  end)

  it("goes when it is told to, and says when that is too fast", function()
    run:set_parameter("go", 1)
    run:set_parameter("forward_m_s", 0.64)
    run:advance_to("go")
    expect(run.log).to_contain "faster than it walks"
    run:set_parameter("go", 0)
    run:advance(0.1)
    expect(run.state).to_equal "stand"
  end)

  it("gets up when it lies, and gives up when it cannot", function()
    run:advance(1)
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
    expect(run:finish(60)).to_equal "failed"
  end)
end)

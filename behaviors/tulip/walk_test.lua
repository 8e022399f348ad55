-- kadans behavior test behaviors/tulip/walk_test.lua
local k = require "kadans"

describe("walk", function()
  local run
  before_each(function() run = k.play "walk.lua" end)

  it("bends its knees first, then goes", function()
    run:advance(0.7)
    expect(run.state).to_equal "set_out"
    expect(run.joints.l_knee.position_rad).to_be_above(0.7)
    run:advance(0.2)
    expect(run.state).to_equal "go"
  end)

  it("gets up when it lies", function()
    run:advance_to("go")
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
  end)

  it("says when it is told to be faster than it walks, and stays", function()
    run:set_parameter("forward_m_s", 0.64)
    run:advance_to("go")
    expect(run.log).to_contain "faster than it walks"
  end)
end)

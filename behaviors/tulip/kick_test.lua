-- kadans behavior test behaviors/tulip/kick_test.lua
local k = require "kadans"

describe("kick", function()
  local run
  before_each(function() run = k.play "kick.lua" end)

  it("bends its knees, then asks for the kick where the ball lies", function()
    run:advance(0.7)
    expect(run.state).to_equal "set_out"
    run:advance(0.3)
    expect(run.state).to_equal "kick"
  end)

  it("says when it shall kick further to a side than it can", function()
    run:set_parameter("rad", 0.55)
    run:set_parameter("far_m", 4.5)
    run:advance_to("kick")
    run:advance(0.1)
    expect(run.log).never.to_contain "no kick"
  end)

  it("gives a ball up that it does not reach", function()
    run:set_parameter("ball_x_m", 2)
    run:set_parameter("within_s", 2)
    run:advance_to("kick")
    run:advance(2.1)
    expect(run.state).to_equal "stop"
  end)
end)

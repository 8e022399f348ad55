-- kadans behavior test behaviors/tulip/go_to_ball_test.lua
local k = require "kadans"

describe("go_to_ball", function()
  local run
  before_each(function() run = k.play "go_to_ball.lua" end)

  local function see(x_m, y_m, age_s)
    run:set_sensor("seen.ball.confidence", 1)
    run:set_sensor("seen.ball.age_s", age_s)
    run:set_sensor("seen.ball.x_m", x_m)
    run:set_sensor("seen.ball.y_m", y_m)
  end

  it("looks for the ball until it sees it", function()
    run:advance(3)
    expect(run.state).to_equal "search"
    see(1, 0.2, 0.1)
    run:advance(0.05)
    expect(run.state).to_equal "approach"
  end)

  it("looks for a ball again that it has not seen for long", function()
    see(1, 0.2, 0.1)
    run:advance_to("approach")
    run:set_sensor("seen.ball.age_s", 100)  -- no new picture
    run:advance(1.9)
    expect(run.state).to_equal "approach"
    run:advance(0.2)
    expect(run.state).to_equal "search"
  end)

  it("stands when the ball is beyond the target", function()
    run:advance_to("search")
    see(5, 0, 0.1)
    run:advance(0.05)
    expect(run.state).to_equal "stop"
  end)

  it("gets up when it lies", function()
    see(1, 0.2, 0.1)
    run:advance_to("approach")
    run:set_sensor("base.pitch_rad", 1.5)
    run:set_sensor("base.tilt_rad", 1.5)
    run:set_sensor("base.posture", 1)
    run:advance(0.1)
    expect(run.state:sub(1, 6)).to_equal "fallen"
  end)
end)

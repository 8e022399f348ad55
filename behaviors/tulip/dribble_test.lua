-- kadans behavior test behaviors/tulip/dribble_test.lua
local k = require "kadans"

describe("dribble", function()
  local run
  before_each(function() run = k.play "dribble.lua" end)

  local function see(x_m, y_m, age_s)
    run:set_sensor("seen.ball.confidence", 1)
    run:set_sensor("seen.ball.age_s", age_s)
    run:set_sensor("seen.ball.x_m", x_m)
    run:set_sensor("seen.ball.y_m", y_m)
  end

  it("looks for the ball until it sees it, and again when it has not seen it for long", function()
    run:advance(2)
    expect(run.state).to_equal "search"
    see(1, 0.1, 0.1)
    run:advance(0.05)
    expect(run.state).to_equal "dribble"
    run:set_sensor("seen.ball.age_s", 100)  -- no new picture
    run:advance(2.1)
    expect(run.state).to_equal "search"
  end)

  it("stands when the ball is as far as it shall go", function()
    run:set_parameter("for_m", 1)
    see(1, 0, 0.1)
    run:advance_to("dribble")
    see(2.3, 0, 0.1)
    run:advance(0.1)
    expect(run.state).to_equal "stop"
  end)

  it("gets up when it lies", function()
    see(1, 0, 0.1)
    run:advance_to("dribble")
    run:set_sensor("base.pitch_rad", 1.5)
    run:set_sensor("base.tilt_rad", 1.5)
    run:set_sensor("base.posture", 1)
    run:advance(0.1)
    expect(run.state:sub(1, 6)).to_equal "fallen"
  end)
end)

-- kadans behavior test behaviors/tulip/dribble_test.lua
local k = require "kadans"

describe("dribble", function()
  local run
  before_each(function() run = k.play "dribble.lua" end)

  it("looks for the ball until it sees it, and again when it has not seen it for long", function()
    run:advance(2)
    expect(run.state).to_equal "search"
    run:set_seen("ball", { x_m = 1, y_m = 0.1 })
    run:advance(0.05)
    expect(run.state).to_equal "dribble"
    run:set_sensor("seen.ball.age_s", 100)  -- no new picture
    run:advance(2.1)
    expect(run.state).to_equal "search"
  end)

  it("stands when the ball is as far as it shall go", function()
    run:set_parameter("for_m", 1)
    run:set_seen("ball", { x_m = 1, y_m = 0 })
    run:advance_to("dribble")
    run:set_seen("ball", { x_m = 2.3, y_m = 0 })
    run:advance(0.1)
    expect(run.state).to_equal "stop"
  end)

  it("gets up when it lies", function()
    run:set_seen("ball", { x_m = 1, y_m = 0 })
    run:advance_to("dribble")
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
  end)
end)

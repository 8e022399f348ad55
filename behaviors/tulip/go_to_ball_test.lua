-- kadans behavior test behaviors/tulip/go_to_ball_test.lua
local k = require "kadans"

describe("go_to_ball", function()
  local run
  before_each(function() run = k.play "go_to_ball.lua" end)

  it("looks for the ball until it sees it", function()
    run:advance(3)
    expect(run.state).to_equal "search"
    run:set_seen("ball", { x_m = 1, y_m = 0.2 })
    run:advance(0.05)
    expect(run.state).to_equal "approach"
  end)

  it("looks for a ball again that it has not seen for long", function()
    run:set_seen("ball", { x_m = 1, y_m = 0.2 })
    run:advance_to("approach")
    run:set_sensor("seen.ball.age_s", 100)  -- no new picture
    run:advance(1.9)
    expect(run.state).to_equal "approach"
    run:advance(0.2)
    expect(run.state).to_equal "search"
  end)

  it("stands when the ball is beyond the target", function()
    run:advance_to("search")
    run:set_seen("ball", { x_m = 5, y_m = 0 })
    run:advance(0.05)
    expect(run.state).to_equal "stop"
  end)

  it("takes a ball for there when it is a little beyond the target only from near, where it sees that", function()
    for target_m, state in pairs { [4] = "approach", [0.5] = "stop" } do
      run = k.play "go_to_ball.lua"
      run:set_parameter("target_x_m", target_m)
      run:advance_to("search")
      run:set_seen("ball", { x_m = target_m + 0.15, y_m = 0 })
      run:advance(0.05)
      expect(run.state).to_equal(state)
    end
  end)

  it("gets up when it lies", function()
    run:set_seen("ball", { x_m = 1, y_m = 0.2 })
    run:advance_to("approach")
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
  end)
end)

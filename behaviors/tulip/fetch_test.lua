-- kadans behavior test behaviors/tulip/fetch_test.lua
local k = require "kadans"

describe("fetch", function()
  local run
  before_each(function() run = k.play("fetch.lua", { scenario = "config/scenarios/fetch.json" }) end)

  local function see(x_m, y_m) run:set_seen("ball", { x_m = x_m, y_m = y_m, carried = true }) end
  local function last() return run.orders[#run.orders] end

  it("stands until it sees a ball that lies still", function()
    run:advance(1)
    expect(#run.orders).to_equal(1)
    expect(last()).to_equal { word = "replace", list = "stand", arguments = {} }
    for i = 1, 8 do  -- it rolls
      see(2, 0.5 * i)
      run:advance(0.5)
    end
    expect(run.state).to_equal "search"
    run:advance(0.8)
    expect(run.state).to_equal "go"
  end)

  it("goes to a place 0.6 m before the ball, and looks at it there", function()
    see(1.6, 1.2)
    run:advance_to("go")
    expect(last().list).to_equal "walk_to"
    expect(last().arguments.x_m).to_be_near(1.12, 1e-9)
    expect(last().arguments.y_m).to_be_near(0.84, 1e-9)
    expect(last().arguments.heading_rad).to_be_near(math.atan2(1.2, 1.6), 1e-9)
  end)

  it("waves when it is there, and is done", function()
    see(2, 0)
    run:advance_to("go")
    run:play_ends()
    run:advance(0.1)
    expect(run.state).to_equal "greet"
    expect(last().list).to_equal "wave"
    run:play_ends()
    expect(run:finish(1)).to_equal "done"
  end)

  it("searches again when it could not go there, and forgets where the ball was", function()
    see(2, 0)
    run:advance_to("go")
    run:play_ends("failed")
    run:advance(0.1)
    expect(run.state).to_equal "search"
    expect(last().list).to_equal "stand"
    run:advance(0.5)
    expect(run.state).to_equal "search"
  end)

  it("does not go to a ball that the odometry lost, or that was not seen for long", function()
    see(2, 0)
    run:set_sensor("seen.ball.carried", false)
    run:advance(2)
    expect(run.state).to_equal "search"
    run:set_sensor("seen.ball.carried", true)
    run:set_sensor("seen.ball.age_s", 0.6)
    run:advance(2)
    expect(run.state).to_equal "search"
  end)

  it("gets up wherever it falls, and searches again", function()
    see(2, 0)
    run:advance_to("go")
    run:set_posture "prone"
    run:advance(0.1)
    expect(run.state).to_equal "fallen"
    expect(last().list).to_equal "get_up"
    run:set_posture "upright"
    run:play_ends()
    run:advance(0.1)
    expect(run.state).to_equal "search"
  end)
end)

-- kadans behavior test behaviors/looking/watch_test.lua
local k = require "kadans"

describe("watch", function()
  local run
  before_each(function() run = k.play "watch.lua" end)

  it("turns the camera to the point on the left", function()
    run:advance_to("right")
    expect(run.joints.pan.position_rad).to_be_near(0.540, 0.01)
  end)

  it("says what it cannot do, and does not move for it", function()
    expect(run:finish(10)).to_equal "done"
    expect(run.log).to_contain "straight up: out_of_reach by 0.7"
    expect(run.log).to_contain "at once: too_quick, pan would be too fast"
    expect(run.joints.pan.position_rad).to_be_near(-0.464, 0.01)
  end)
end)

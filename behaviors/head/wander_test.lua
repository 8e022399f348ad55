local k = require "kadans"

describe("wander", function()
  it("turns as far as it can to what is behind, and comes back", function()
    local run = k.play("wander.lua", { robot = "config/head/robot.json" })
    run:advance(9.5)
    expect(math.abs(run.joints.pan.position_rad)).to_be_above(1.5)
    expect(run:finish(30)).to_equal "done"
    expect(run.joints.pan.position_rad + run.joints.left_eye_pan.position_rad).to_be_near(-0.06, 0.05)
  end)
end)

local k = require "kadans"

describe("look", function()
  it("looks left, right, and ahead again", function()
    local run = k.play("look.lua", { robot = "config/jiwiy/robot.json" })
    run:advance(0.9)
    expect(run.joints.pan.position_rad).to_be_above(0.6)
    run:advance(1.0)
    expect(run.joints.pan.position_rad).to_be_below(-0.6)
    expect(run:finish(5)).to_equal "done"
    expect(run.joints.pan.position_rad).to_be_near(0, 0.01)
  end)
end)

local k = require "kadans"

describe("stick", function()
  it("leads the eyes to the left at first, and comes back", function()
    local run = k.play("stick.lua", { robot = "config/head/robot.json" })
    run:advance(1)
    expect(run.joints.pan.position_rad + run.joints.left_eye_pan.position_rad).to_be_above(0.1)
    expect(run:finish(10)).to_equal "done"
  end)
end)

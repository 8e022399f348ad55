local k = require "kadans"

describe("stick", function()
  local run
  before_each(function() run = k.play("stick.lua", { robot = "config/jiwiy/robot.json" }) end)

  it("turns the pan as fast as the stick says", function()
    run:advance(0.2)
    expect(run.joints.pan.velocity_rad_s).to_be_near(1.4, 0.15)
  end)

  it("comes to rest when the stick is let go", function()
    run:set_parameter("lasts_s", 1)
    expect(run:finish(5)).to_equal "done"
    run:advance(0.2)
    expect(run.joints.pan.velocity_rad_s).to_be_near(0, 0.01)
    expect(run.joints.tilt.velocity_rad_s).to_be_near(0, 0.01)
  end)
end)

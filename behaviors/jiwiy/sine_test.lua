local k = require "kadans"

describe("sine", function()
  it("measures amplitude and phase of a robot that follows at once", function()
    local run = k.play("sine.lua", { robot = "config/jiwiy/robot.json" })
    expect(run:finish(10)).to_equal "done"
    expect(run.log).to_contain "pan: gain"
  end)

  it("leads both joints as far as it is told", function()
    local run = k.play("sine.lua", { robot = "config/jiwiy/robot.json" })
    run:set_parameter("pan_rad", 1)
    run:advance_to("follow")
    run:advance(2.25)
    expect(run.joints.pan.position_rad).to_be_near(1, 0.03)
    expect(run.joints.tilt.position_rad).to_be_near(0.4, 0.02)
  end)

  it("fails when the joints do not follow as well as it wants", function()
    local run = k.play("sine.lua", { robot = "config/jiwiy/robot.json" })
    run:set_parameter("phase_deg", 0)
    run:set_parameter("gain_error", 0)
    expect(run:finish(10)).to_equal "failed"
    expect(run.log).to_contain "does not follow"
  end)
end)

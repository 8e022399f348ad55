local k = require "kadans"

describe("wave", function()
  it("raises one arm, waves, and brings it back", function()
    local run = k.play "wave.lua"
    run:advance(1.3)
    expect(run.joints.r_shoulder_pitch.position_rad).to_be_near(-1.8, 0.1)
    expect(run.joints.l_shoulder_pitch.position_rad).to_be_near(-0.2, 0.05)
    expect(run:finish(20)).to_equal "done"
    expect(run.joints.r_shoulder_pitch.position_rad).to_be_near(-0.2, 0.05)
  end)

  it("waves as far as it is told", function()
    local run = k.play "wave.lua"
    run:set_parameter("swing_rad", 0.5)
    run:advance(1.9)
    expect(run.joints.r_shoulder_pitch.position_rad).to_be_near(-2.3, 0.1)
  end)
end)

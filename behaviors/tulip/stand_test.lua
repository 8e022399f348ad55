local k = require "kadans"

describe("stand", function()
  it("takes the pose and stays in it", function()
    local run = k.play "stand.lua"
    run:advance(3)
    expect(run.joints.l_knee.position_rad).to_be_near(0.3, 0.02)
    expect(run.state).to_equal "stand"
  end)
end)

local legs = require "legs"

describe("legs", function()
  it("bends a leg so that the foot stays parallel to the torso", function()
    local bent = legs.bend(0.3, 0.2, 0.4)
    expect(bent.hip_pitch + bent.knee + bent.ankle_pitch).to_be_near(0)
    expect(legs.distance(0.3, 0.2, bent.knee)).to_be_near(0.4)
  end)

  it("stretches a leg to its whole length", function()
    expect(legs.bend(0.275, 0.275, 0.55).knee).to_be_near(0, 1e-6)
  end)

  it("refuses what a leg cannot reach, with its length", function()
    expect(function() legs.bend(0.275, 0.275, 0.6) end).to_raise "a leg of 0.550 m cannot put its ankle 0.600 m below"
  end)

  it("lowers a pose by as much as it is told", function()
    local pose = { l_hip_pitch = -0.15, l_knee = 0.3, l_ankle_pitch = -0.15 }
    local lower = legs.lowered(pose, { "l_" }, 0.275, 0.275, 0.1)
    local before, after = legs.distance(0.275, 0.275, 0.3), legs.distance(0.275, 0.275, lower.l_knee)
    expect(before - after).to_be_near(0.1)
    expect(lower.l_hip_pitch + lower.l_knee + lower.l_ankle_pitch).to_be_near(0)
  end)
end)

local floor = require "floor"

local function joints(left, right)
  return { l_shoulder_pitch = { position_rad = left }, r_shoulder_pitch = { position_rad = right } }
end

describe("floor", function()
  it("tells a torso that lies from one that stands or is on its way down", function()
    for posture, lies in pairs { upright = false, falling = false, prone = true, supine = true, left = true, right = true } do
      expect(floor.lies { posture = posture }).to_equal(lies)
    end
  end)

  it("takes an arm the nearer way round, within the shoulder's limits", function()
    expect(floor.nearest_turn(1.81, 0.2)).to_equal(0)
    expect(floor.nearest_turn(1.81, -4.0)).to_be_near(-2 * math.pi)
    expect(floor.nearest_turn(-4.0, 2.0)).to_be_near(2 * math.pi)
    expect(floor.nearest_turn(1.0, -4.6)).to_equal(0)
  end)

  it("keeps each arm's turns all through the fold", function()
    local steps, turns = floor.fold(joints(-4.0, 0.2))
    expect(turns.l_shoulder_pitch).to_be_near(-2 * math.pi)
    expect(turns.r_shoulder_pitch).to_equal(0)
    for _, step in ipairs(steps) do
      expect(step[1].l_shoulder_pitch).to_be_above(-4.651)
      expect(step[1].r_shoulder_pitch).to_be_below(4.651)
      expect(step[1].l_knee).to_equal(step[1].r_knee)
    end
  end)

  it("ends the rise in the pose stand, whichever way the arms came", function()
    local points = floor.rise({ l_shoulder_pitch = -2 * math.pi, r_shoulder_pitch = 0 }, 0.1)
    local last = points[#points][1]
    expect(last.l_shoulder_pitch).to_be_near(-0.2)
    expect(last.r_shoulder_pitch).to_be_near(-0.2)
    expect(last.l_hip_pitch).to_be_near(-0.15)
    expect(last.l_ankle_pitch).to_be_near(-0.194)
    expect(points[1][1].l_ankle_pitch).to_be_near(0.166)
    expect(#points).to_be_below(17)
  end)

  it("mirrors the roll for the right side", function()
    local left, right = floor.roll("left", joints(0, 0)), floor.roll("right", joints(0, 0))
    expect(left[1][1].r_knee).to_equal(right[1][1].l_knee)
    expect(left[1][1].l_hip_roll).to_equal(-right[1][1].r_hip_roll)
  end)
end)

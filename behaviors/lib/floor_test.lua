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

  local up_to = { torso = 1.9, hip = -2.3, knee = 0.25, ankle = 0.15, arm = 4.35 }
  local function folded(change)
    local v = setmetatable(change or {}, { __index = up_to })
    local s = { joints = {}, base = { roll_rad = math.pi, pitch_rad = math.pi - v.torso, angular_velocity_rad_s = { y = v.rate or 0 } } }
    for _, leg in ipairs { "l_", "r_" } do
      s.joints[leg .. "hip_pitch"] = { position_rad = v.hip }
      s.joints[leg .. "knee"] = { position_rad = v.knee }
      s.joints[leg .. "ankle_pitch"] = { position_rad = v.ankle }
      s.joints[leg .. "shoulder_pitch"] = { position_rad = v.arm }
    end
    return s
  end

  it("finds the centre of mass, and whether it is over flat soles", function()
    local level = { ahead = 0, left = 0 }
    local x, z = floor.centre(folded())
    expect(x).to_be_near(0.02, 0.02)
    expect(z).to_be_near(0.35, 0.02)
    expect(floor.over_soles(folded(), level, 0.06)).to_be_true()
    expect(floor.over_soles(folded { torso = 2.4, ankle = -0.35 }, level, 0.06)).to_be_false()  -- ahead of the soles
    expect(floor.over_soles(folded { torso = 2.1 }, level, 0.06)).to_be_false()  -- on its toes
    expect(floor.over_soles(folded { rate = 1 }, level, 0.06)).to_be_false()  -- falls forward
  end)

  it("feels the slope of the ground on its face, and turns the ankles by so much", function()
    expect(floor.slope { pitch_rad = 0.5, roll_rad = 0 }).to_be_nil()
    local slope = floor.slope { pitch_rad = math.pi / 2 - 0.05, roll_rad = 0 }
    expect(slope.ahead).to_be_near(0.05, 0.001)
    expect(slope.left).to_be_near(0, 0.001)
    local steep, flat = floor.rise({}, 0, 1, slope), floor.rise({}, 0, 1)
    expect(steep[8][1].l_ankle_pitch).to_be_near(flat[8][1].l_ankle_pitch - 0.05, 0.001)
  end)

  it("tells a leg that lies across, and lays arms and legs apart", function()
    local at = folded().joints
    for joint, target in pairs(floor.prone(at)) do at[joint] = { position_rad = target } end
    expect(floor.caught(at)).to_be_false()
    at.l_hip_roll = { position_rad = -0.2 }
    expect(floor.caught(at)).to_be_true()
    local arms = floor.prone(joints(-4.0, 1.0))
    expect(arms.l_shoulder_pitch).to_be_near(-math.pi)
    expect(arms.r_shoulder_pitch).to_be_near(0.2)
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

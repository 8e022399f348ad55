local poses = require "poses"

describe("poses", function()
  it("mirrors sides, and turns yaw and roll over", function()
    local mirrored = poses.mirrored { l_knee = 1, r_hip_roll = 0.2, l_hip_yaw = 0.3, neck_yaw = 0.4, neck_pitch = 0.5 }
    expect(mirrored).to_equal { r_knee = 1, l_hip_roll = -0.2, r_hip_yaw = -0.3, neck_yaw = -0.4, neck_pitch = 0.5 }
  end)

  it("mirrored twice is the pose itself", function()
    local pose = { l_knee = 1, r_hip_roll = 0.2 }
    expect(poses.mirrored(poses.mirrored(pose))).to_equal(pose)
  end)

  it("gives one side's joints to both, what is written for a side wins", function()
    expect(poses.both { l_knee = 1, l_hip_roll = 0.1 })
      .to_equal { l_knee = 1, r_knee = 1, l_hip_roll = 0.1, r_hip_roll = -0.1 }
  end)

  it("lays a change over a pose and leaves the pose alone", function()
    local pose = { l_knee = 1, r_knee = 1 }
    expect(poses.with(pose, { r_knee = 2 })).to_equal { l_knee = 1, r_knee = 2 }
    expect(pose.r_knee).to_equal(1)
  end)

  it("finds the pose between two", function()
    expect(poses.between({ l_knee = 1, r_knee = 5 }, { l_knee = 3 }, 0.25)).to_equal { l_knee = 1.5 }
  end)
end)

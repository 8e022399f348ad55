-- kadans behavior test behaviors/tulip/get_up_test.lua
local k = require "kadans"

describe("get_up", function()
  local run
  before_each(function() run = k.play "get_up.lua" end)

  local function lies(posture)
    run:set_posture(posture)
    run:set_sensor("feet.left.contact", true)
    run:set_sensor("feet.right.contact", true)
  end
  -- On hands and feet, the torso 2.1 rad from upright: the centre of mass is over the soles then.
  local function folded()
    run:set_sensor("base.roll_rad", math.pi)
    run:set_sensor("base.pitch_rad", math.pi - 2.1)
  end
  local function stands()
    run:set_posture "upright"
    run:set_sensor("base.height_m", 0.86)
  end

  it("lies still before it begins", function()
    lies "prone"
    run:advance(0.7)
    expect(run.state).to_equal "lie"
    run:advance(0.2)
    expect(run.state).to_equal "fold"
  end)

  it("frees a leg that lies across before it folds", function()
    lies "prone"
    run:set_sensor("joints.l_hip_roll.position_rad", -0.2)
    run:advance(0.9)
    expect(run.state).to_equal "face"
    run:advance_to("fold")
  end)

  it("folds onto hands and feet from its face, rises, and is up after two seconds of standing", function()
    run:set_parameter("flat_s", 2)  -- sensors that are set by hand tell the balance nothing
    lies "prone"
    run:advance_to("bear")
    folded()
    run:advance_to("rise")
    expect(run.joints.l_hip_pitch.position_rad).to_be_near(-2.3, 0.05)
    run:advance(0.9)
    stands()
    run:advance_to("steady.stands")
    expect(run.joints.l_hip_pitch.position_rad).to_be_near(-0.15, 0.05)
    run:advance(1.9)
    expect(run.state).to_equal "steady.stands"
    expect(run:finish(5)).to_equal "done"
    expect(run.states).to_contain "stands at_once up"
  end)

  it("waits on hands and feet until its mass is over its soles, but not for ever", function()
    lies "prone"
    run:advance_to("bear")
    run:set_sensor("base.roll_rad", math.pi)
    run:set_sensor("base.pitch_rad", 1.5)  -- the torso as low as on the face
    run:advance(2.9)
    expect(run.state).to_equal "bear"
    run:advance(0.2)
    expect(run.state).to_equal "rise"
  end)

  it("does not rise when it has tipped over", function()
    lies "prone"
    run:advance_to("bear")
    lies "right"
    run:advance(0.4)
    expect(run.states).to_contain "bear again"
  end)

  it("rolls onto its face first, over the side that it lies on", function()
    lies "supine"
    run:advance(0.9)
    expect(run.state).to_contain "roll"
    run:advance(0.5)
    lies "prone"
    run:advance_to("fold")
    expect(run.states).to_contain "fold"
  end)

  it("rolls over the right side when it lies there", function()
    lies "right"
    run:advance(0.9)
    expect(run.state).to_equal "roll_right"
  end)

  it("tries again when it falls, and says so at the end", function()
    lies "prone"
    run:advance_to("bear")
    folded()
    run:advance_to("rise")
    lies "prone"
    run:advance(1.2)
    expect(run.state).to_equal "lie"
    run:advance_to("bear")
    folded()
    run:advance_to("rise")
    run:advance(0.9)
    stands()
    expect(run:finish(10)).to_equal "done"
    expect(run.states).to_contain "stands up"
  end)

  it("gives up after as many tries as it is told", function()
    run:set_parameter("tries", 2)
    lies "supine"  -- and never rolls over
    expect(run:finish(30)).to_equal "failed"
  end)
end)

-- kadans behavior test behaviors/tulip/step_out_test.lua
local k = require "kadans"

describe("step_out", function()
  local run
  before_each(function() run = k.play "step_out.lua" end)

  local function lies()
    run:set_sensor("base.pitch_rad", 1.5)
    run:set_sensor("base.tilt_rad", 1.5)
    run:set_sensor("feet.left.contact", true)
    run:set_sensor("feet.right.contact", true)
  end

  it("stands with its left foot ahead, its soles flat", function()
    run = k.play("step_out.lua", { plant = "bullet" })
    run:advance(1)
    expect(run.state).to_equal "stand"
    local j = run.joints
    expect(j.l_hip_pitch.position_rad < j.r_hip_pitch.position_rad - 0.15).to_equal(true)
    for _, side in ipairs { "l", "r" } do
      local sole = j[side .. "_hip_pitch"].position_rad + j[side .. "_knee"].position_rad + j[side .. "_ankle_pitch"].position_rad
      expect(sole).to_be_near(0, 0.05)
    end
    run:advance(20)
    expect(run.state).to_equal "stand"
  end)

  it("has caught itself once the foot that was behind has come down ahead", function()
    run:advance(1)
    run:set_sensor("joints.r_hip_pitch.position_rad", -0.9)
    run:set_sensor("feet.left.contact", true)
    run:advance(0.2)
    expect(run.state).to_equal "stand"
    run:set_sensor("feet.right.contact", true)
    run:advance(0.1)
    expect(run.state).to_equal "caught"
    run:advance(20)
    expect(run.state).to_equal "caught"
  end)

  it("gets up when it lies, and stands its ground on parallel feet", function()
    run:advance(1)
    lies()
    run:advance(0.1)
    expect(run.state).to_contain "fallen"
    run:advance_to("fallen.get_up.bear")
    run:set_sensor("base.roll_rad", math.pi)
    run:set_sensor("base.pitch_rad", math.pi - 2.1)
    run:advance_to("fallen.get_up.rise")
    run:advance(0.9)
    run:set_sensor("base.pitch_rad", 0)
    run:set_sensor("base.tilt_rad", 0)
    run:set_sensor("base.height_m", 0.86)
    run:advance_to("upright.stay_up.stand")
    run:advance(0.2)
    expect(run.joints.l_hip_pitch.position_rad).to_be_near(run.joints.r_hip_pitch.position_rad, 0.02)
  end)

  it("gives up when it cannot get up", function()
    run:advance(1)
    lies()
    expect(run:finish(60)).to_equal "failed"
  end)
end)

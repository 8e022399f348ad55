-- kadans behavior test behaviors/tulip/dive_test.lua
local k = require "kadans"

describe("dive", function()
  it("pulls up the leg of the side to which it falls, pushes with the other one, and ends", function()
    for left = 0, 1 do
      local run = k.play("dive.lua", { plant = "bullet" })
      run:set_parameter("left", left)
      run:advance(0.25)
      local up, pushes = run.joints.l_knee, run.joints.r_knee
      if left == 0 then up, pushes = pushes, up end
      expect(up.position_rad).to_be_above(pushes.position_rad + 0.5)
      expect(run:finish(5)).to_equal "done"
    end
  end)
end)

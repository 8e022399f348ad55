local k = require "kadans"
local gestures = require "gestures"

describe("gestures", function()
  it("go through poses as often as they are told, and say how many there were", function()
    local run = k.play("behaviors/jiwiy/look.lua", { robot = "config/jiwiy/robot.json" })
    run:set_parameter("times", 2)
    run:advance(3.5)
    expect(run.state).to_equal "around.poses.going"
    expect(run:finish(5)).to_equal "done"
    expect(run.result).to_equal { poses = 6 }
  end)

  it("refuse arguments that they do not have, values out of range, and no poses", function()
    local function through(arguments) return function() gestures.through "x" (arguments) end end
    expect(through { poses = { "left" }, tims = 2 }).to_raise "skill 'through' takes no argument 'tims', did you mean 'times'?"
    expect(through { poses = { "left" }, times = 0 }).to_raise "argument 'times' of skill 'through' = 0 is outside its range 1..100"
    expect(through {}).to_raise "poses is empty"
  end)
end)

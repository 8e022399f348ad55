-- kadans behavior test behaviors/tulip/footwork_test.lua
local k = require "kadans"

describe("footwork", function()
  local run
  before_each(function()
    run = k.play "footwork.lua"
    run:advance_to("obeys")
  end)

  it("stands until somebody says where to go, and again when nobody does any more", function()
    run:advance(0.2)
    expect(run.state).to_equal "obeys"
    run:emit("foot.go", { x_m = 2, y_m = 0, heading_rad = 0 })
    run:advance(0.5)
    expect(run.control_sets).to_equal "walking"
    run:advance(2)
    expect(run.state).to_equal "obeys"
  end)

  it("refuses places that are none", function()
    expect(function() run:emit("foot.go", { x_m = 200, y_m = 0, heading_rad = 0 }) end).to_raise "outside its range -30..30 m"
    expect(function() run:emit("foot.turn", {}) end).to_raise "rad_s"
  end)

  it("dribbles a ball that it sees, until it shall do something else", function()
    run:set_seen("ball", { x_m = 0.35, y_m = 0.09 })
    run:emit("foot.dribble", { x_m = 4, y_m = 0 })
    run:advance(0.5)
    expect(run.state).to_equal "obeys"
    run:emit("foot.stand")
    run:advance(0.5)
    run:emit("foot.dribble", { x_m = 4, y_m = 0 })
    run:advance(0.1)
    expect(run.error).to_equal ""
    expect(function() run:emit("foot.dribble", { x_m = 4, y_m = 0, most_m_s = 2 }) end).to_raise "most_m_s"
  end)

  it("throws itself to the side that it is told, and gets up", function()
    run:emit("foot.dive", { left = 0 })
    run:advance(0.1)
    expect(run.state:sub(1, 10)).to_equal "dive_right"
    run:advance(2)
    expect(run.state:sub(1, 6)).to_equal "fallen"
    expect(run.error).to_equal ""
  end)

  it("lets itself fall to the side to which it leans on something, and does not for a short sway", function()
    run:set_sensor("base.roll_rad", 0.7)
    run:set_sensor("base.tilt_rad", 0.7)
    run:advance(0.5)
    expect(run.state).to_equal "obeys"
    run:advance(0.7)
    expect(run.state:sub(1, 10)).to_equal "dive_right"
    expect(run.error).to_equal ""
  end)

  it("gets up when it lies, and hears meanwhile", function()
    run:set_posture "prone"
    run:advance_to("fallen", 0.1)
    run:emit("foot.stand")
    run:advance(0.1)
    expect(run.error).to_equal ""
  end)
end)

-- kadans behavior test behaviors/tulip/walk_led_test.lua
local k = require "kadans"

describe("walk_led", function()
  local run
  before_each(function()
    run = k.play "walk_led.lua"
    run:advance_to("waits")
  end)

  it("is led while somebody says how fast, and stops when nobody does", function()
    for _ = 1, 10 do
      run:emit("cmd_vel", { forward_m_s = 0.2 })
      run:advance(0.2)
      expect(run.state).to_equal "led"
    end
    run:advance(0.6)
    expect(run.state).to_equal "waits"
  end)

  it("says once what it cannot do, and goes on as before", function()
    for _ = 1, 3 do
      run:emit("cmd_vel", { forward_m_s = 5 })
      run:advance(0.1)
    end
    expect(run.state).to_equal "led"
    expect(run.log).to_contain "it goes on as before: forward_m_s = 5 is faster than it walks"
    local _, times = run.log:gsub("as before", "")
    expect(times).to_equal(1)
  end)

  it("takes no velocity that is no number", function()
    expect(function() run:emit("cmd_vel", { forward_m_s = 0 / 0 }) end).to_raise "forward_m_s"
  end)
end)

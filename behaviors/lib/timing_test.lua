local timing = require "timing"

describe("timing", function()
  it("says how long a condition has held, and forgets when it breaks", function()
    local held = timing.held()
    expect(held(1.0, true)).to_equal(0)
    expect(held(1.5, true)).to_equal(0.5)
    expect(held(1.6, false)).to_equal(0)
    expect(held(2.0, true)).to_equal(0)
  end)

  it("counts down from its first reading", function()
    local left = timing.timer(2)
    expect(left(10)).to_equal(2)
    expect(left(11.5)).to_equal(0.5)
    expect(left(13)).to_equal(0)
  end)

  it("does not flicker between its thresholds", function()
    local fallen = timing.hysteresis(1.0, 0.5)
    expect(fallen(0.7)).to_equal(false)
    expect(fallen(1.0)).to_equal(true)
    expect(fallen(0.7)).to_equal(true)
    expect(fallen(0.5)).to_equal(false)
  end)

  it("refuses thresholds the wrong way round", function()
    expect(function() timing.hysteresis(0.5, 1.0) end).to_raise "on (0.5) must be larger than off (1)"
  end)
end)

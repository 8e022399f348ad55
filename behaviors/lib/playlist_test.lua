local k = require "kadans"
local playlist = require "playlist"

describe("playlist", function()
  it("plays one behavior after the other", function()
    local run = k.play "behaviors/tulip/show.lua"
    expect(run:finish(60)).to_equal "done"
    expect(run.states).to_contain "show.item_1.squat"
    expect(run.states).to_contain "show.item_2.wave"
  end)

  it("ends at the first that fails", function()
    local run = k.play "behaviors/tulip/show.lua"
    run:advance(1)
    run:set_sensor("safety.level", "hold")
    expect(run:finish(5)).to_equal "failed"
    expect(run.states).never.to_contain "item_2"
  end)

  it("refuses an empty list", function()
    expect(function() playlist.state("show", {}) end).to_raise "the list is empty"
  end)
end)

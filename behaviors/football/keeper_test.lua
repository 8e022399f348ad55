-- kadans behavior test behaviors/football/keeper_test.lua
local keeper = require "keeper"

local me = { number = 1, keeper = 1, players = 2, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 }
local s = { seen = { me = me, game = { state = 3, set_play = 0, ours = -1 } } }
local pose = { x_m = -4.2, y_m = 0, heading_rad = 0 }
local function ball(x_m, y_m, x_m_s, y_m_s)
  return { x_m = x_m, y_m = y_m, rolls = { x_m_s = x_m_s, y_m_s = y_m_s, m_s = math.sqrt(x_m_s ^ 2 + y_m_s ^ 2) } }
end

describe("keeper", function()
  it("throws itself to the side on which a ball rolls into the goal", function()
    expect(keeper.passes(s, pose, ball(-3, 0, -1.4, 0.7))).to_equal "left"
    expect(keeper.passes(s, pose, ball(-3, 0, -1.4, -0.7))).to_equal "right"
    expect(keeper.passes(s, { x_m = -4.2, y_m = 0, heading_rad = math.pi }, ball(-3, 0, -1.4, 0.7))).to_equal "right"
  end)

  it("believes a kick from near as soon as it shows", function()
    local kicked = { x_m = -2.75, y_m = 0.11, kicked = { from = { x_m = -3, y_m = 0 }, x_m = -3.25, y_m = 0.11 } }
    expect(keeper.passes(s, pose, kicked)).to_equal "left"
    kicked.kicked.x_m = -2.75
    expect(keeper.passes(s, pose, kicked)).to_be_nil()
  end)

  it("stays up for one that comes to it, rests before, misses the goal or comes late", function()
    expect(keeper.passes(s, pose, ball(-3, 0, -1.4, 0.05))).to_be_nil()
    expect(keeper.passes(s, pose, ball(0, 0, -1, 0.2))).to_be_nil()
    expect(keeper.passes(s, pose, ball(-3, 1, -1.4, 1.4))).to_be_nil()
    expect(keeper.passes(s, pose, ball(0, 0, -1.9, 0.2))).to_be_nil()
    expect(keeper.passes(s, pose, { x_m = -3, y_m = 0 })).to_be_nil()
    expect(keeper.passes(s, pose, nil)).to_be_nil()
  end)

  it("looks around while nobody is about to shoot, and not when somebody is", function()
    local m = { vars = { others = {} } }
    local rests = { x_m = -2, y_m = -0.5 }
    expect(keeper.is_calm(m, s, pose, rests)).to_be_true()
    m.vars.others = { { x_m = -1.5, y_m = -0.3 } }
    expect(keeper.is_calm(m, s, pose, rests)).to_be_false()
    expect(keeper.is_calm({ vars = { others = {} } }, s, pose, ball(-2, 0, -1, 0))).to_be_false()
    expect(keeper.is_calm(m, s, pose, { x_m = 3, y_m = 0 })).to_be_true()
    expect(keeper.is_calm(m, s, pose, nil)).to_be_true()
  end)
end)

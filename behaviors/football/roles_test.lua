-- kadans behavior test behaviors/football/roles_test.lua
local roles = require "roles"

local function robot(number, keeper)
  local me = { number = number, keeper = keeper, players = 2, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75 }
  return { vars = { mates = {}, others = {}, role = "none" } }, { time_s = 10, seen = { me = me, game = { state = 3, set_play = 0 } } }
end
local ball, near, far = { x_m = 1, y_m = 0 }, { x_m = 0.3, y_m = 0, heading_rad = 0 }, { x_m = -3, y_m = 0, heading_rad = 0 }

describe("roles", function()
  it("lets the keeper keep, and one that is alone strike", function()
    local m, s = robot(1, 1)
    m.vars.mates[2] = { heard_s = 9, plays = true, far_s = 5, role = "striker" }
    expect(roles.pick(m, s, far, ball)).to_equal "keeper"
    m, s = robot(2, 1)
    expect(roles.pick(m, s, far, ball)).to_equal "striker"
  end)

  it("sends the keeper to the ball when no mate plays, and no opponent is there sooner", function()
    local m, s = robot(1, 1)
    m.vars.mates[2], m.vars.heard = { heard_s = 9, plays = false, far_s = 5, role = "striker" }, true
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
    m.vars.others = { { x_m = 1.5, y_m = 0, mate = false } }
    expect(roles.pick(m, s, near, ball)).to_equal "keeper"
    s.seen.game.set_play, s.seen.game.ours = 6, 1  -- its team's corner: the opponent keeps away
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
    s.seen.game.set_play = 0
    m.vars.others, m.vars.mates, m.vars.heard = {}, {}, false  -- silent
    expect(roles.pick(m, s, near, ball)).to_equal "keeper"
  end)

  it("lets the one that is faster at the ball strike, on both sides alike", function()
    local m, s = robot(2, 1)
    m.vars.mates[3] = { heard_s = 9, plays = true, far_s = roles.far(near, ball), role = "none" }
    expect(roles.pick(m, s, far, ball)).to_equal "supporter"
    m, s = robot(3, 1)
    m.vars.mates[2] = { heard_s = 9, plays = true, far_s = roles.far(far, ball), role = "none" }
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
  end)

  it("leaves the ball to a mate when its battery is low, but goes when it is alone", function()
    local m, s = robot(2, 1)
    m.vars.mates[3] = { heard_s = 9, plays = true, far_s = roles.far(far, ball), role = "none" }
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
    m.vars.saves = true
    expect(roles.pick(m, s, near, ball)).to_equal "supporter"
    expect(roles.told(m, near, ball)).to_be_near(roles.far(near, ball) + 20, 1e-9)
    m.vars.mates = {}
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
  end)

  it("leaves a ball before the own goal to the keeper, but not to one that is off the field or lies", function()
    local m, s = robot(2, 1)
    local before_goal, here = { x_m = -3.5, y_m = 0 }, { x_m = -2, y_m = 0, heading_rad = 0 }
    expect(roles.pick(m, s, here, before_goal)).to_equal "striker"
    m.vars.mates[1] = { heard_s = 9, plays = true, far_s = 3, role = "keeper" }
    expect(roles.pick(m, s, here, before_goal)).to_equal "supporter"
    m.vars.mates[1] = { heard_s = 9, plays = false, far_s = 3, role = "keeper" }
    expect(roles.pick(m, s, here, before_goal)).to_equal "striker"
    local lies_s = roles.far({ x_m = -4, y_m = 1, heading_rad = 0 }, before_goal, true)
    m.vars.mates[1] = { heard_s = 9, plays = true, far_s = lies_s + 5, role = "keeper" }
    expect(roles.pick(m, s, here, before_goal)).to_equal "striker"
  end)

  it("does not count a mate that is silent or may not play", function()
    local m, s = robot(2, 1)
    m.vars.mates[3] = { heard_s = 1, plays = true, far_s = 0, role = "striker" }
    expect(roles.pick(m, s, far, ball)).to_equal "striker"
    m.vars.mates[3] = { heard_s = 9, plays = false, far_s = 0, role = "striker" }
    expect(roles.pick(m, s, far, ball)).to_equal "striker"
  end)

  it("sends nobody to a ball that it must leave to others, and tells its mates so", function()
    local m, s = robot(2, 1)
    m.vars.leaves_ball = true
    expect(roles.pick(m, s, near, ball)).to_equal "supporter"
    expect(roles.told(m, near, ball)).to_be_above(50)
    m.vars.leaves_ball = false
    expect(roles.pick(m, s, near, ball)).to_equal "striker"
    expect(roles.told(m, near, ball)).to_be_below(10)
  end)
end)

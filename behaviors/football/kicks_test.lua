-- kadans behavior test behaviors/football/kicks_test.lua
local kicks = require "kicks"

local unseen = { confidence = 0, age_s = 0 }
local function situation(can)
  local s = {
    time_s = 10,
    seen = {
      robot_1 = unseen, robot_2 = unseen, robot_3 = unseen,
      game = { ours = -1, set_play = 0 },
      me = { number = 2, keeper = 1, players = 3, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 },
    },
  }
  return { vars = { mates = {}, others = {}, can = can or { pass = true, dribble = true } } }, s
end
local function sees(m, s, pose, x_m, y_m)  -- an opponent there; the robot faces the goal
  s.seen.robot_1 = { confidence = 1, age_s = 0, x_m = x_m - pose.x_m, y_m = y_m - pose.y_m, mate = 0 }
  kicks.look(m, s, pose)
end
local function facing(x_m, y_m) return { x_m = x_m, y_m = y_m, heading_rad = 0 } end

describe("kicks", function()
  it("shoots at the open goal", function()
    local m, s = situation()
    expect(kicks.choose(m, s, facing(2.6, 0), { x_m = 3, y_m = 0 }).name).to_equal "shoot"
  end)

  it("aims beside the keeper", function()
    local m, s = situation()
    local pose = facing(2.6, 0)
    sees(m, s, pose, 4, -0.2)
    local kick = kicks.choose(m, s, pose, { x_m = 3, y_m = 0 })
    expect(kick.name).to_equal "shoot"
    expect(kick.y_m).to_be_above(0.3)
  end)

  it("passes to a mate before the goal when an opponent stands in its own way, unless it may not", function()
    local m, s = situation()
    local pose = facing(1.1, -2)
    sees(m, s, pose, 2.2, -1.7)
    m.vars.mates[3] = { heard_s = 9.5, plays = true, x_m = 2.6, y_m = 0.2 }
    local kick = kicks.choose(m, s, pose, { x_m = 1.5, y_m = -2 })
    expect(kick.name).to_equal "pass"
    expect(kick.to).to_equal(3)
    m, s = situation { pass = false, dribble = true }
    sees(m, s, pose, 2.2, -1.7)
    expect(kicks.choose(m, s, pose, { x_m = 1.5, y_m = -2 }).name == "pass").to_be_false()
  end)

  it("passes at a free kick of a team of three, since it may not go on with the ball by itself", function()
    local pose, ball = facing(-0.5, 0), { x_m = 0, y_m = 0 }
    local function chosen(mate_plays)
      local m, s = situation()
      sees(m, s, pose, 2, -1)
      s.seen.game = { ours = 1, set_play = 2, state = 3 }
      m.vars.heard = true
      m.vars.mates[1] = { heard_s = 9.5, plays = mate_plays, x_m = -4, y_m = 0 }
      m.vars.mates[3] = { heard_s = 9.5, plays = true, x_m = 1, y_m = 1.5 }
      return kicks.choose(m, s, pose, ball).name
    end
    expect(chosen(true)).to_equal "pass"
    expect(chosen(false)).to_equal "dribble"
  end)

  it("remembers an opponent that is out of sight for a while", function()
    local m, s = situation()
    local pose = facing(2.6, 0)
    sees(m, s, pose, 4, 0)
    s.seen.robot_1, s.time_s = unseen, 12
    kicks.look(m, s, pose)
    expect(#m.vars.others).to_equal(1)
    s.time_s = 15
    kicks.look(m, s, pose)
    expect(#m.vars.others).to_equal(0)
  end)

  it("keeps what it has chosen while nothing is clearly better", function()
    local m, s = situation()
    local first = kicks.choose(m, s, facing(1.5, 0), { x_m = 2, y_m = 0 })
    s.time_s = 10.5
    local second = kicks.choose(m, s, facing(1.55, 0.1), { x_m = 2.02, y_m = 0.03 })
    expect(second.name).to_equal(first.name)
    expect(second.y_m).to_be_near(first.y_m, 0.05)
  end)

  it("does not dribble back", function()
    local m, s = situation()
    local pose, ball = { x_m = 0.6, y_m = 0.3, heading_rad = -2.5 }, { x_m = 0, y_m = 0 }
    s.seen.robot_1 = { confidence = 1, age_s = 0, x_m = 1, y_m = -0.5, mate = 0 }
    kicks.look(m, s, pose)
    local kick = kicks.choose(m, s, pose, ball)
    expect(kick.x_m - ball.x_m).to_be_above(-0.25)
  end)

  it("holds going around the ball for the worse the longer the ball has rested", function()
    local m, s = situation()
    local pose, ball = { x_m = 0, y_m = -0.4, heading_rad = math.pi / 2 }, { x_m = 0, y_m = 0 }
    local function lead()  -- of the shot, for which it goes around, over the kick as it comes
      local shot, along = -10, -10
      for _, kick in ipairs(kicks.all(m, s, pose, ball)) do
        if kick.name == "shoot" then shot = math.max(shot, kick.worth) end
        if kick.name == "dribble" and math.abs(kick.x_m) < 0.1 then along = math.max(along, kick.worth) end
      end
      return shot - along
    end
    local early = lead()
    s.time_s = 19
    expect(lead()).to_be_below(early - 0.2)
  end)

  it("kicks a ball that lies on the goal line over it", function()
    local m, s = situation()
    local kick = kicks.choose(m, s, facing(4.1, 0.9), { x_m = 4.52, y_m = 0.9 })
    expect(kick.name).to_equal "shoot"
    expect(kick.x_m).to_be_above(4.6)
  end)
end)

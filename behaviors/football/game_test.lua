-- kadans behavior test behaviors/football/game_test.lua
local game = require "game"
local ready = require "ready"

local function told(state, more)
  local s = {
    time_s = 10,
    seen = {
      game = { confidence = 1, age_s = 0, state = state, set_play = 0, ours = 1, stopped = 0, penalty = 0, remaining_s = 100, secondary_s = 10 },
      whistle = { confidence = 0, count = 0 },
      me = { number = 2, keeper = 1, players = 3, length_m = 9, width_m = 6, goal_m = 2.6, circle_m = 0.75, mark_m = 1.5 },
    },
  }
  for name, value in pairs(more or {}) do s.seen.game[name] = value end
  return s
end
local function robot() return { vars = { mates = {}, whistled = false, whistles = 0 } } end

-- A robot of three that took a free kick, by which the ball went from `lay` to `at`.
local function took_a_kick(mates_play, lay, at)
  local m, pose = { vars = { mates = {}, others = {}, heard = true, role = "striker" } }, { x_m = lay.x_m - 0.3, y_m = 0 }
  for number = 1, 3, 2 do m.vars.mates[number] = { heard_s = 9, plays = mates_play, x_m = -3, y_m = 0 } end
  expect(game.leaves_ball(m, told(3, { set_play = 1, ours = 1 }), pose, lay)).to_be_false()
  return m, game.leaves_ball(m, told(3, { ours = -1 }), pose, at), pose
end

describe("game", function()
  it("waits, goes to its place and plays as the game controller says", function()
    local m = robot()
    expect(game.phase(told(0), m)).to_equal "wait"
    expect(game.phase(told(1), m)).to_equal "ready"
    expect(game.phase(told(2), m)).to_equal "wait"
    expect(game.phase(told(3), m)).to_equal "play"
    expect(game.phase(told(3, { stopped = 1 }), m)).to_equal "wait"
    expect(game.phase(told(3, { penalty = 5 }), m)).to_equal "wait"
    expect(game.phase(told(3, { confidence = 0 }), m)).to_equal "wait"
  end)

  it("stands when its battery is empty, and saves it before", function()
    local m, s = robot(), told(3)
    expect(game.saves(s)).to_be_false()
    for _, row in ipairs { { 0.5, "play", false }, { 0.1, "play", true }, { 0.02, "wait", true } } do
      s.seen.battery = { confidence = 1, charge = row[1] }
      expect(game.phase(s, m)).to_equal(row[2])
      expect(game.saves(s)).to_equal(row[3])
    end
    s.seen.battery = { confidence = 0, charge = 0 / 0 }  -- nothing tells of it
    expect(game.phase(s, m)).to_equal "play"
  end)

  it("plays from the whistle on, which is no word of another half's", function()
    local m, s = robot(), told(2)
    s.seen.whistle = { confidence = 1, count = 1 }
    game.listen(m, s)
    expect(game.phase(s, m)).to_equal "play"
    expect(game.kick_off(s, m)).to_equal "ours"
    game.listen(m, told(1))
    s = told(2, { ours = 0 })
    s.seen.whistle = { confidence = 1, count = 1 }
    game.listen(m, s)
    expect(game.phase(s, m)).to_equal "wait"
  end)

  it("leaves the ball of its own free kick to others until one of them is there, or for 20 s", function()
    local lay, at = { x_m = 1, y_m = 0 }, { x_m = 2, y_m = 0 }
    local m, leaves, pose = took_a_kick(true, lay, at)
    expect(leaves).to_be_true()
    expect(game.leaves_ball(m, told(3, { ours = -1 }), pose, at)).to_be_true()
    m.vars.others = { { x_m = 2.2, y_m = 0.1 } }
    expect(game.leaves_ball(m, told(3, { ours = -1 }), pose, at)).to_be_false()
    m, leaves, pose = took_a_kick(true, lay, at)
    local s = told(3, { ours = -1 })
    s.time_s = 31
    expect(leaves).to_be_true()
    expect(game.leaves_ball(m, s, pose, at)).to_be_false()
  end)

  it("does not when its team has two on the field, when the ball still lies there, or the others kicked", function()
    local lay, at = { x_m = 1, y_m = 0 }, { x_m = 2, y_m = 0 }
    local _, leaves = took_a_kick(false, lay, at)
    expect(leaves).to_be_false()
    _, leaves = took_a_kick(true, lay, lay)
    expect(leaves).to_be_false()
    local m = { vars = { mates = {}, others = {}, heard = false, role = "striker" } }
    expect(game.leaves_ball(m, told(3, { set_play = 1, ours = 0 }), { x_m = 0.7, y_m = 0 }, lay)).to_be_false()
    expect(game.leaves_ball(m, told(3, { ours = -1 }), { x_m = 0.7, y_m = 0 }, at)).to_be_false()
  end)
end)

describe("ready", function()
  it("stands in its own half, at the others' kick-off outside of the circle", function()
    for number = 1, 4 do
      for ours = 0, 1 do
        local s = told(1, { ours = ours })
        s.seen.me.number = number
        local place = ready.place(s)
        expect(place.x_m).to_be_below(-0.3)
        if ours == 0 then expect(place.x_m ^ 2 + place.y_m ^ 2).to_be_above(1.1 ^ 2) end
      end
    end
  end)

  it("stands behind the ball of its own penalty kick, and far from that of the others", function()
    local s = told(1, { set_play = 3, ours = 1 })
    expect(ready.place(s).x_m).to_be_near(4.5 - 1.5 - 0.6, 1e-9)
    s.seen.me.number = 3
    expect(ready.place(s).x_m).to_be_below(4.5 - 1.5 - 0.75 - 0.4)
    s = told(1, { set_play = 3, ours = 0 })
    expect(ready.place(s).x_m).to_be_above(-4.5 + 2.6)
    s.seen.me.number = 1
    expect(ready.place(s).x_m).to_equal(-4.5)
  end)
end)

-- kadans behavior test behaviors/football/radio_test.lua
local game = require "game"
local radio = require "radio"

local pose = { x_m = -1, y_m = 0.5, heading_rad = 0 }

local function robot() return { vars = { mates = {}, rolling = {}, role = "striker", told_s = 9, told_say = 3, told_role = "striker", told_pass = false } } end
local function knows(advice)
  return {
    time_s = 10,
    seen = {
      radio = advice or { confidence = 0 }, ball = { confidence = 0 }, whistle = { confidence = 0 },
      game = { confidence = 1, state = 3, set_play = 0, ours = 1, stopped = 0, penalty = 0 },
      me = { number = 2, keeper = 1, players = 2 },
    },
  }
end
local function says(left, say) return { confidence = 1, left = left, say = say } end

describe("radio", function()
  it("tells when a message is worth its price, and news at once", function()
    local m = robot()
    expect(radio.is_due(m, knows(says(50, 3)), false, 1)).to_be_false()
    expect(radio.is_due(m, knows(says(50, 4)), false, 1)).to_be_true()
    expect(radio.is_due(m, knows(says(50, 3)), true, 1)).to_be_true()
    m.vars.told_s = 9.9
    expect(radio.is_due(m, knows(says(50, 3)), true, 1)).to_be_false()
  end)

  it("is silent when the budget is spent, whatever the news", function()
    expect(radio.is_due(robot(), knows(says(0.5, 9)), true, 1)).to_be_false()
  end)

  it("tells once a second when nobody says when it is worth it", function()
    local m = robot()
    expect(radio.is_due(m, knows(), false, 1)).to_be_true()
    m.vars.told_s = 9.5
    expect(radio.is_due(m, knows(), false, 1)).to_be_false()
  end)

  it("tells where it sees the ball, and a mate knows where that has rolled to", function()
    local sent, m, s = nil, robot(), knows(says(50, 4))
    m.send = function(_, event, data) sent = { event = event, data = data } end
    radio.tell(m, s, pose, { x_m = 1, y_m = 0, own = true, age_s = 0.1, rolls = { x_m_s = 1, y_m_s = 0, m_s = 1 } }, 1)
    expect(sent.event).to_equal "robot.tell"
    expect(m.vars.told_say).to_equal(4)
    local mate, later = robot(), knows()
    later.event = { data = sent.data }
    radio.hear(mate, later)
    later.time_s = 11
    local ball = game.ball(mate, later, pose)
    expect(ball.own).to_be_false()
    expect(ball.x_m).to_be_near(1 + 1.1 - 0.14 * 1.1 ^ 2, 0.01)
    later.time_s = 16
    expect(game.ball(mate, later, pose)).to_be_nil()
  end)

  it("tells the mate of a pass when it is about to kick, and not while it walks to the ball", function()
    local sent, m = nil, robot()
    m.send = function(_, _, data) sent = data end
    m.vars.kick = { to = 3, chosen_s = 9.9 }
    radio.tell(m, knows(says(50, 4)), pose, { x_m = 1, y_m = 0, own = true }, 1)
    expect(sent.pass_to).to_be_nil()
    radio.tell(m, knows(says(50, 5)), pose, { x_m = -0.6, y_m = 0.5, own = true }, 1)
    expect(sent.pass_to).to_equal(3)
  end)

  it("does not pass on what it has by hearsay", function()
    local sent, m = nil, robot()
    m.send = function(_, _, data) sent = data end
    radio.tell(m, knows(says(50, 4)), pose, { x_m = 1, y_m = 0, own = false }, 1)
    expect(sent.ball_x_m).to_be_nil()
  end)
end)

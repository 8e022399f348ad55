-- Moves to a target of the whole body that is drawn anew in each run, in a time that is drawn too, and back again. A
-- motion that is refused as too quick gets the least time that the refusal told. config/sweeps/whole_body_anywhere.json
-- plays it.
local k = require "kadans"

local P = k.params {
  least_s   = { 0.3, min = 0.1, max = 10, unit = "s", doc = "least time of a motion" },
  longest_s = { 3.0, min = 0.1, max = 10, unit = "s", doc = "longest time of a motion" },
  tries     = { 20, min = 1, max = 100, doc = "how many targets are drawn until one is reached" },
  hold_s    = { 1.0, min = 0, max = 10, unit = "s", doc = "time to stay there" },
}

local function between(low, high) return low + (high - low) * math.random() end

local kinds = { "centre of mass", "trunk", "right hand", "left hand", "all" }

-- A target of the centre of mass, of the trunk, of a hand, or of all of them; its weight; and what it is of.
local function draw(m)
  local kind = math.random(5)
  local over = {}
  if kind == 1 or kind == 5 then
    over.com_m = { between(-0.09, 0.15), between(-0.14, 0.14), m.body:setpoint("com_z_m") - between(-0.02, 0.22) }
  end
  if kind == 2 or kind == 5 then
    over.trunk = { roll_rad = between(-0.25, 0.25), pitch_rad = between(-0.3, 0.55), yaw_rad = between(-0.5, 0.5) }
  end
  for name, of in pairs { hand_right = 3, hand_left = 4 } do
    if kind == of or kind == 5 then
      local y_m = m.body:setpoint(name .. "_y_m") + between(-0.05, 0.05)
      over[name .. "_m"] = { between(-0.3, 0.7), y_m, between(0.2, 1.3) }
    end
  end
  return over, kind >= 3 and 30 or nil, kinds[kind]
end

-- Returns the motion's time; nil: it was refused.
local function go(m, over, time_s, weight)
  local motion, why, much, what = m.body:move(over, { time_s = time_s, weight = weight })
  if why == "too_quick" then
    k.log.info("refused: %s", what)
    time_s = much + 0.01
    motion, why, much, what = m.body:move(over, { time_s = time_s, weight = weight })
  end
  if motion then return time_s end
  k.log.info("refused: %s %.3f %s", why, much, what)
end

return k.behavior "anywhere" {
  controls = "body",
  vars     = { time_s = 0, from_x_m = 0, from_y_m = 0, from_z_m = 0, roll_rad = 0, pitch_rad = 0, yaw_rad = 0 },
  initial  = "settle",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "settle" {
    { after = 0.5, to = "seek" },
  },
  k.state "seek" {
    run = function(m)
      local v = m.vars
      for _, axis in ipairs { "x", "y", "z" } do v["from_" .. axis .. "_m"] = m.body:setpoint("com_" .. axis .. "_m") end
      for _, turn in ipairs { "roll_rad", "pitch_rad", "yaw_rad" } do v[turn] = m.body:setpoint("trunk." .. turn) end
      for _ = 1, P.tries do
        local over, weight, kind = draw(m)
        v.time_s = go(m, over, between(P.least_s, P.longest_s), weight) or 0
        if v.time_s > 0 then
          k.log.info("goes there in %.2f s: %s", v.time_s, kind)
          return
        end
        m:wait(0.02)
      end
    end,
    { on = "run.done", when = function(_, m) return m.vars.time_s > 0 end, to = "there" },
    { on = "run.done", to = "nowhere" },
  },
  k.state "there" {
    run = function(m) m:wait(m.vars.time_s + P.hold_s) end,
    { on = "run.done", to = "back" },
  },
  k.state "back" {
    run = function(m)
      local v = m.vars
      for _, hand in ipairs { "hand_right", "hand_left" } do m.body:set_parameter(hand .. ".weight", 0) end
      local over = {
        com_m = { v.from_x_m, v.from_y_m, v.from_z_m },
        trunk = { roll_rad = v.roll_rad, pitch_rad = v.pitch_rad, yaw_rad = v.yaw_rad },
      }
      m:wait((go(m, over, v.time_s) or 0) + P.hold_s)
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done"    { outcome = "done" },
  k.final "nowhere" { outcome = "done" },
  k.final "failed"  { outcome = "failed" },
}

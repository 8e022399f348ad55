// The additional names that tests of behaviors see.
#pragma once

#include <lua.hpp>

namespace kadans {

// [-5 +0] Makes the five values at the top of the stack the names describe, it, before_each, expect and k.play, in this
// order.
void open_test_names(lua_State* state);

// The part of the test kit that is written in Lua.

// The matchers after `expect(x).` and `expect(x).never.`
inline constexpr const char* test_matchers[] = {"to_equal",   "to_be_near",  "to_be_above", "to_be_below", "to_contain",
                                                "to_be_true", "to_be_false", "to_be_nil",   "to_raise"};

// Given (play, advance, read, change, add_test, is_in); returns k.play, expect, before_each, it, describe.
inline constexpr char test_prelude[] = R"(
local play, advance, read, change, add_test, is_in = ...
local names, hooks, inside = {}, {}, false

local function show(value, depth)
  if type(value) == "string" then return string.format("%q", value) end
  if type(value) == "number" then return string.format("%.9g", value) end
  if type(value) ~= "table" or depth > 3 then return tostring(value) end
  local parts = {}
  for key, field in pairs(value) do
    local left = type(key) == "number" and "" or tostring(key) .. " = "
    parts[#parts + 1] = left .. show(field, depth + 1)
  end
  return "{ " .. table.concat(parts, ", ") .. " }"
end

local function same(a, b)
  if type(a) ~= "table" or type(b) ~= "table" then return a == b end
  for key, field in pairs(a) do
    if not same(field, rawget(b, key)) then return false end
  end
  for key in pairs(b) do
    if rawget(a, key) == nil then return false end
  end
  return true
end

local function number(value) return type(value) == "number" end
local matchers = {
  to_equal = function(a, b) return same(a, b), "to equal " .. show(b, 0) end,
  to_be_near = function(a, b, within)
    local bound = within or 1e-6
    return number(a) and math.abs(a - b) <= bound, "to be near " .. show(b, 0) .. " within " .. show(bound, 0)
  end,
  to_be_above = function(a, b) return number(a) and a > b, "to be above " .. show(b, 0) end,
  to_be_below = function(a, b) return number(a) and a < b, "to be below " .. show(b, 0) end,
  to_contain = function(a, b)
    return type(a) == "string" and a:find(b, 1, true) ~= nil, "to contain " .. show(b, 0)
  end,
  to_be_true = function(a) return a == true, "to be true" end,
  to_be_false = function(a) return a == false, "to be false" end,
  to_be_nil = function(a) return a == nil, "to be nil" end,
  to_raise = function(a, part)
    local ok, message = pcall(a)
    local found = not ok and (part == nil or tostring(message):find(part, 1, true) ~= nil)
    return found, "to raise " .. show(part or "an error", 0) .. (ok and "" or ", not " .. show(message, 0))
  end,
}

local function expectation(value, wanted, word)
  local made = {}
  for name, matcher in pairs(matchers) do
    made[name] = function(...)
      local good, text = matcher(value, ...)
      if (not not good) ~= wanted then error("expected " .. show(value, 0) .. word .. text, 2) end
    end
  end
  return setmetatable(made, { __index = function(_, key)
    error("expect(...) has no '" .. tostring(key) .. "'; there is: to_equal, to_be_near, to_be_above, to_be_below, " ..
          "to_contain, to_be_true, to_be_false, to_be_nil, to_raise, and never", 2)
  end })
end

local function expect(value)
  local made = expectation(value, true, " ")
  made.never = expectation(value, false, " never ")
  return made
end

local function describe(name, body)
  if type(name) ~= "string" then error("describe needs a name, then a function", 2) end
  if type(body) ~= "function" then error("describe(" .. show(name, 0) .. ") needs a function", 2) end
  names[#names + 1], hooks[#hooks + 1] = name, {}
  body()
  names[#names], hooks[#hooks] = nil, nil
end

local function before_each(body)
  local level = hooks[#hooks]
  if level == nil then error("before_each belongs into describe", 2) end
  level[#level + 1] = body
end

-- Kept for when the file is loaded; what goes before it is what stands above it.
local function it(name, body)
  if inside then error("it belongs into describe, not into another it", 2) end
  if type(name) ~= "string" then error("it needs a name, then a function", 2) end
  if type(body) ~= "function" then error("it(" .. show(name, 0) .. ") needs a function", 2) end
  local before = {}
  for _, level in ipairs(hooks) do
    for _, hook in ipairs(level) do before[#before + 1] = hook end
  end
  add_test(table.concat(names, " ") .. (#names > 0 and " " or "") .. name, function()
    inside = true
    for _, hook in ipairs(before) do hook() end
    body()
  end)
end

local methods = {}
function methods.advance(run, seconds)
  if type(seconds) ~= "number" or not (seconds >= 0 and seconds <= 3600) then
    error("advance needs seconds, 0..3600", 2)
  end
  advance(run.id, seconds)
end
-- Advances until this state, by its path, is active; raises when it is not within max_s (default 60).
function methods.advance_to(run, state, max_s)
  if type(state) ~= "string" then error("advance_to needs the path of a state", 2) end
  local left_s = max_s or 60
  while true do
    local there, unknown = is_in(run.id, state)
    if there then return end
    if unknown then error(unknown, 2) end
    if run.outcome ~= "" and run.states:match("%S+$") == state then return end  -- a final state, in which it ended
    if left_s <= 0 or run.outcome ~= "" then
      error(string.format("%q was not reached within %g s: the behavior is in %s", state, max_s or 60,
                          run.outcome == "" and table.concat(run.active, ", ") or show(run.outcome, 0)), 2)
    end
    advance(run.id, 0.01)
    left_s = left_s - 0.01
  end
end
-- Advances until the behavior is over and returns its outcome.
function methods.finish(run, max_s)
  local left_s = max_s or 60
  while run.outcome == "" and left_s > 0 do
    advance(run.id, 0.01)
    left_s = left_s - 0.01
  end
  return run.outcome
end
function methods.emit(run, event, data)
  if type(event) ~= "string" then error("emit needs the name of an event", 2) end
  if data ~= nil and type(data) ~= "table" then error("emit: the data is a table { name = value }", 2) end
  local why = change(run.id, "event", event, data or {})
  if why ~= true then error(why, 2) end
end
function methods.set_parameter(run, name, value)
  if not change(run.id, "parameter", name, value) then
    error("no parameter '" .. tostring(name) .. "', or the value is outside its range", 2)
  end
end
local levels = { normal = 0, limited = 1, hold = 2, damp = 3, off = 4 }
local function set_sensor(run, name, value)
  local as_number = value
  if value == true then as_number = 1 elseif value == false then as_number = 0 end
  if type(value) == "string" then as_number = levels[value] end
  if type(as_number) ~= "number" then error("what it measures is a number, true, false or a safety level", 3) end
  if not change(run.id, "sensor", name, as_number) then
    error("no sensor '" .. tostring(name) .. "': it is written like \"base.pitch_rad\"", 3)
  end
end
function methods.set_sensor(run, name, value) set_sensor(run, name, value) end
-- The base as it is when the robot stands upright, or lies on one of its sides.
local attitudes = {
  upright = { roll_rad = 0, pitch_rad = 0, tilt_rad = 0, posture = 0 },
  prone = { roll_rad = 0, pitch_rad = 1.5, tilt_rad = 1.5, posture = 1 },
  supine = { roll_rad = 0, pitch_rad = -1.5, tilt_rad = 1.5, posture = 2 },
  left = { roll_rad = -1.5, pitch_rad = 0, tilt_rad = 1.5, posture = 3 },
  right = { roll_rad = 1.5, pitch_rad = 0, tilt_rad = 1.5, posture = 4 },
}
function methods.set_posture(run, posture)
  local attitude = attitudes[posture]
  if attitude == nil then error("set_posture needs upright, prone, supine, left or right", 2) end
  for name, value in pairs(attitude) do set_sensor(run, "base." .. name, value) end
end
-- An entry of the world model that has just been seen, with these values.
function methods.set_seen(run, entry, values)
  if type(entry) ~= "string" or type(values) ~= "table" then
    error("set_seen needs an entry of the world model and values of it, like \"ball\", { x_m = 1 }", 2)
  end
  local seen = { confidence = 1, age_s = 0 }
  for name, value in pairs(values) do seen[name] = value end
  for name, value in pairs(seen) do set_sensor(run, "seen." .. entry .. "." .. tostring(name), value) end
end

-- Of decisions: what they played has ended, with "done" unless another outcome is given.
function methods.play_ends(run, outcome)
  local why = change(run.id, "ends", outcome or "done", "")
  if why ~= true then error(why, 2) end
end
-- Of decisions: a behavior that plays is in this state.
function methods.plays(run, behavior, state)
  if type(behavior) ~= "string" or type(state) ~= "string" then error("plays needs a behavior and its state", 2) end
  local why = change(run.id, "plays", behavior, state)
  if why ~= true then error(why, 2) end
end

local function test_play(file, options)
  if type(file) ~= "string" then error("k.play needs the file of a behavior", 2) end
  if options ~= nil and type(options) ~= "table" then error("k.play: options are a table, { robot = FILE }", 2) end
  options = options or {}
  for key, value in pairs(options) do
    if key ~= "robot" and key ~= "plant" and key ~= "scenario" then
      error("k.play has no option '" .. tostring(key) .. "'; there are: robot, plant, scenario", 2)
    end
    if type(value) ~= "string" then error("k.play: " .. key .. " must be a text, not a " .. type(value), 2) end
  end
  local id = play(file, options.robot or "", options.plant or "", options.scenario or "")
  return setmetatable({ id = id }, { __index = function(_, key) return methods[key] or read(id, key) end })
end
return describe, it, before_each, expect, test_play
)";

}  // namespace kadans

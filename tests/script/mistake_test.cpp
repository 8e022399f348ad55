// Mistakes that authors make, each with the message it must give: the line, what is wrong, what was meant.
#include <doctest/doctest.h>

#include "script/check/check_behavior.h"
#include "script/fixture.h"

namespace mistake_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

struct Mistake {
  std::string text;
  std::string message;  // how it begins
};

const Mistake at_load[] = {
    {"x = 1", "behaviors/test.lua:1: 'x' would be a global: write local x"},
    {"local y = string.fromat('%d', 1)", "behaviors/test.lua:1: string has no 'fromat', did you mean 'format'?"},
    {"local y = maths.pi", "behaviors/test.lua:1: unknown name 'maths', did you mean 'math'?"},
    {"local k = require 'kadan'", "behaviors/test.lua:1: no module 'kadan'"},
    {"local k = require 'kadans'\nreturn k.behaviour 't' {}",
     "behaviors/test.lua:2: kadans has no 'behaviour', did you mean 'behavior'?"},
    {"local k = require 'kadans'\nlocal s = k.state 'a'\nreturn s",
     "behaviors/test.lua:1: the file must return k.behavior"},
    {"return 3", "behaviors/test.lua:1: the file must return k.behavior"},
    {"local x =\n= 3", "behaviors/test.lua:2: unexpected symbol near '='"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\nentr = print } }",
     "behaviors/test.lua:3: k.state has no key 'entr', did you mean 'enter'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\ncontrol = 'posture', k.state 'a' {} }",
     "behaviors/test.lua:3: k.behavior has no key 'control', did you mean 'controls'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\ncontrols = 'postur', k.state 'a' {} }",
     "behaviors/test.lua:3: unknown control set 'postur' in 'controls', did you mean 'posture'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'lie',\nk.state 'lie' {\n{ after = 1,\n to = 'ris' "
     "} },\nk.state 'rise' {} }",
     "behaviors/test.lua:5: unknown state 'ris' in 'to', did you mean 'rise'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'li', k.state 'lie' {}, k.state 'b' {} }",
     "behaviors/test.lua:2: unknown initial state 'li', did you mean 'lie'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'lie' {}, k.state 'b' {} }",
     "behaviors/test.lua:2: this needs initial = \"...\""},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {},\nk.state 'a' {} }",
     "behaviors/test.lua:3: a second state 'a' beside the one in line 2"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ whn = print, to = 'a' } } }",
     "behaviors/test.lua:3: a transition has no key 'whn', did you mean 'when'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' { { when = print } } }",
     "behaviors/test.lua:2: a transition needs 'to'"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ after = -1, to = 'a' } } }",
     "behaviors/test.lua:3: 'after' must be seconds >= 0"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ after = '1', to = 'a' } } }",
     "behaviors/test.lua:3: 'after' must be seconds >= 0"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\nenter = 'go' } }",
     "behaviors/test.lua:3: 'enter' must be a function, not a string"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.state 'a' { { when = 3, to = 'a' } } }",
     "behaviors/test.lua:3: 'when' must be a function, not a number"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.state 'a' }",
     "behaviors/test.lua:2: 1: a k.state, k.call or other part without its { ... }?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.state 'a b' {} }",
     "behaviors/test.lua:3: k.state: a name is letters, digits and '_', not \"a b\""},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.parallel 'p' {\nk.state 'a' {} } }",
     "behaviors/test.lua:3: a k.parallel holds k.region"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.region 'a' {} }",
     "behaviors/test.lua:3: k.region 'a' belongs into a k.parallel"},
    {"local k = require 'kadans'\nlocal P = k.params {\nspeed = { 3, min = 0, max = 2 } }",
     "behaviors/test.lua:3: parameter 'speed': the default 3 is outside 0..2"},
    {"local k = require 'kadans'\nlocal P = k.params {\nspeed = { 3, mn = 0 } }",
     "behaviors/test.lua:3: a parameter has no key 'mn', did you mean 'min'?"},
    {"local k = require 'kadans'\nlocal P = k.params {\nspeed = { unit = 's' } }",
     "behaviors/test.lua:3: parameter 'speed' needs a default"},
    {"local k = require 'kadans'\nlocal P = k.params { speed = 1 }\nlocal x = P.sped",
     "behaviors/test.lua:3: k.params has no 'sped', did you mean 'speed'?"},
    {"local k = require 'kadans'\nlocal P = k.params { speed = 1 }\nlocal x = P.speed * 2",
     "behaviors/test.lua:3: a parameter has its value when the behavior runs"},
    {"local k = require 'kadans'\nlocal p = k.pose 'stnd'",
     "behaviors/test.lua:2: unknown pose 'stnd', did you mean 'stand'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = 'x', to = {} } } }",
     "behaviors/test.lua:3: 'to' lists 1 to 32 states, in regions of one k.parallel"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = 'x', to = { 1 } } } }",
     "behaviors/test.lua:3: 'to' must be the name of a state, or a list of names, not a list with a number"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\ninitial = 3, k.state 'a' {} }",
     "behaviors/test.lua:3: 'initial' must be the name of a state, or a list of names, not a number"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = 'x', action = print, internal = true } "
     "} }",
     "behaviors/test.lua:3: 'internal' says how a transition leads into its state: it needs 'to'"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = 'b', internal "
     "= "
     "true } }, k.state 'b' {} }",
     "behaviors/test.lua:3: internal = true is for a target inside 'a', and 'b' is not"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.parallel 'p' {\n{ on = 'x', to = 'a', internal = true },\n"
     "k.region 'r' { k.state 'a' {} } } }",
     "behaviors/test.lua:3: internal = true: a k.parallel has no states but its regions; write the transition into "
     "the"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = 'fault*', to = 'a' } } }",
     "behaviors/test.lua:3: on = \"fault*\": '*' stands for all words behind a dot, on = \"fault.*\", or alone"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ on = { 'a.*.b' }, to = 'a' } } }",
     "behaviors/test.lua:3: on = \"a.*.b\": '*' stands for all words behind a dot"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = { 'b', 'c' } "
     "} },\n"
     "k.parallel 'p' { k.region 'r' { initial = 'b', k.state 'b' {}, k.state 'c' {} } } }",
     "behaviors/test.lua:3: 'p.r.b' and 'p.r.c' cannot be active together: both are in region 'p.r', name one state of "
     "each region"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = { 'a', 'b' } "
     "} },\n"
     "k.state 'b' {} }",
     "behaviors/test.lua:3: 'a' and 'b' cannot be active together: several targets are states in regions of one"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = { 'p', 'b' } "
     "} },\n"
     "k.parallel 'p' { k.region 'r' { k.state 'b' {} } } }",
     "behaviors/test.lua:3: 'p.r.b' is inside 'p': name the inner one alone"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = { 'b', 'b' } "
     "} },\n"
     "k.state 'b' {} }",
     "behaviors/test.lua:3: 'b' is named twice"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'a', k.state 'a' {\n{ on = 'x', to = { 'h', 'b' } "
     "} },\n"
     "k.parallel 'p' { k.history 'h' { deep = true }, k.region 'r' { k.state 'b' {} } } }",
     "behaviors/test.lua:3: 'p.h' brings back all regions: name it alone"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { initial = 'b',\nk.state 'a' { k.state 'b' {} } }",
     "behaviors/test.lua:2: unknown initial state 'b', did you mean 'a.b'?"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.parallel 'p' { initial = 'r.b',\nk.region 'r' { initial = "
     "'a', k.state 'a' {}, k.state 'b' {} } } }",
     "behaviors/test.lua:4: 'p.r' has an initial of its own, and its k.parallel names another one: keep one of them"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.parallel 'p' {\nk.history 'h' {}, k.region 'r' { k.state "
     "'a' "
     "{} } } }",
     "behaviors/test.lua:4: k.history 'h' of a k.parallel needs deep = true: its regions are all active"},
    {"local k = require 'kadans'\nreturn k.behavior 't' {\nk.parallel 'p' { k.history 'h' { deep = true } } }",
     "behaviors/test.lua:3: k.parallel 'p' has no k.region"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'w' { initial = 'h',\nk.history 'h' {}, k.state 'a' "
     "{} } }",
     "behaviors/test.lua:3: history 'h' needs to = \"...\": the state to enter when there is nothing to remember"},
    {"local k = require 'kadans'\nreturn k.behavior 't' { k.state 'w' {\nk.history 'h' { to = 'h' }, k.state 'a' {} } "
     "}",
     "behaviors/test.lua:3: history 'h' needs to = \"...\": the state to enter when there is nothing to remember, not "
     "a"},
};

const Mistake in_a_tick[] = {
    // line 3 is the first of the code
    {"m.postur:move('stand', { time_s = 1 })", "behaviors/test.lua:3: m has no 'postur', did you mean 'posture'?"},
    {"m.posture:mov('stand', { time_s = 1 })",
     "behaviors/test.lua:3: a control object has no 'mov', did you mean 'move'?"},
    {"m.posture.move('stand', { time_s = 1 })", "behaviors/test.lua:3: call it on a control object, with a colon"},
    {"m.posture:move('stnd', { time_s = 1 })", "behaviors/test.lua:3: unknown pose 'stnd', did you mean 'stand'?"},
    {"m.posture:move('stand')", "behaviors/test.lua:3: move needs { time_s = seconds } at the end"},
    {"m.posture:move('stand', { time = 1 })", "behaviors/test.lua:3: move has no key 'time', did you mean 'time_s'?"},
    {"m.posture:move('stand', { time_s = -1 })", "behaviors/test.lua:3: move: time_s must be a number in 0..600 s"},
    {"m.posture:move('stand', { time_s = 0 / 0 })", "behaviors/test.lua:3: move: time_s must be a number in 0..600 s"},
    {"m.posture:move({ l_kne = 1 }, { time_s = 1 })",
     "behaviors/test.lua:3: this pose has no key 'l_kne', did you mean 'l_knee'?"},
    {"m.posture:move({ l_knee = 3 }, { time_s = 1 })",
     "behaviors/test.lua:3: posture.l_knee.position_rad = 3 is outside its range 0..2.35 rad"},
    {"m.posture:move({ l_knee = 0 / 0 }, { time_s = 1 })", "behaviors/test.lua:3: posture.l_knee.position_rad = "},
    {"m.posture:move({ l_knee = 'x' }, { time_s = 1 })",
     "behaviors/test.lua:3: l_knee must be a number in rad, not a string"},
    {"m.posture:move({ l_ankle_roll = 0 }, { time_s = 1 })",
     "behaviors/test.lua:3: 'posture' does not move the joint 'l_ankle_roll'"},
    {"m.posture:move({ 1, 2 }, { time_s = 1 })", "behaviors/test.lua:3: a pose is a table joint = position in rad"},
    {"m.posture:set('l_knee.position', 1)",
     "behaviors/test.lua:3: 'posture' has no set-point 'l_knee.position', did you mean 'l_knee.position_rad'?"},
    {"m.posture:set('l_knee.position_rad', 9)",
     "behaviors/test.lua:3: posture.l_knee.position_rad = 9 is outside its range 0..2.35 rad"},
    {"m.posture:set_gains('stif')", "behaviors/test.lua:3: 'posture' has no gains 'stif', did you mean 'stiff'?"},
    {"m.posture:set_parameter('l_knee.kp', 1)", "behaviors/test.lua:3: 'posture' has no parameter 'l_knee.kp'"},
    {"m.posture:set_parameter('l_knee.kp_Nm_per_rad', 900)",
     "behaviors/test.lua:3: posture.l_knee.kp_Nm_per_rad = 900 is outside its range 0..500"},
    {"local x = s.joints.l_kne", "behaviors/test.lua:3: s.joints has no 'l_kne', did you mean 'l_knee'?"},
    {"local x = s.base.pitch", "behaviors/test.lua:3: s.base has no 'pitch', did you mean 'pitch_rad'?"},
    {"local x = s.joints.l_knee.position",
     "behaviors/test.lua:3: a joint has no 'position', did you mean 'position_rad'?"},
    {"m.x = 1", "behaviors/test.lua:3: m is read-only: 'x' cannot be set"},
    {"s.base.pitch_rad = 1", "behaviors/test.lua:3: s.base is read-only: 'pitch_rad' cannot be set"},
    {"m:wait(1)", "behaviors/test.lua:3: m:wait() works inside `run` only"},
    {"m.posture:move('stand', { time_s = 1 }):wait()", "behaviors/test.lua:3: wait() works inside `run` only"},
    {"m:emit('unheard')", "behaviors/test.lua:3: nothing in this behavior waits for the event 'unheard'"},
    {"local x = nil + 1", "behaviors/test.lua:3: attempt to perform arithmetic on a nil value"},
    {"error('my own')", "behaviors/test.lua:3: my own"},
    {"error({})", "behaviors/test.lua:3: the script raised a value that is not a string"},
    {"string.format('%d', 'x')", "behaviors/test.lua:3: bad argument #2"},
    {"require 'legs'", "behaviors/test.lua:3: require 'legs' belongs at the top of the file"},
    // what behavior check cannot see before a run
    {"local vars = m.vars\nlocal x = vars.n + 1",
     "behaviors/test.lua:4: attempt to perform arithmetic on field 'n' (a nil value): nothing gave it a value"},
    {"local up = s.time_s >= 0\nlocal x = 'up ' .. up",
     "behaviors/test.lua:4: attempt to concatenate local 'up' (a boolean value): tostring(x) makes a text of it"},
    {"local limit = tostring(1)\nif s.time_s < limit then end",
     "behaviors/test.lua:4: attempt to compare number with string: tonumber(text) makes a number of it"},
    {"local limit = 45\nm.posture:move({ l_knee = limit }, { time_s = 1 })",
     "behaviors/test.lua:4: posture.l_knee.position_rad = 45 is outside its range 0..2.35 rad; 45 degrees are 0.785 "
     "rad"},
    {"local name = 'stnd'\nm.posture:move(name, { time_s = 1 })",
     "behaviors/test.lua:4: unknown pose 'stnd', did you mean 'stand'?"},
    {"local event = 'unherd'\nm:emit(event)",
     "behaviors/test.lua:4: nothing in this behavior waits for the event 'unherd'"},
    {"local object = 'postur'\nm[object]:hold()", "behaviors/test.lua:4: m has no 'postur', did you mean 'posture'?"},
    {"local how = 1\nm.posture:move('stand', how)",
     "behaviors/test.lua:4: move: the last argument must be a table { ... }, not a number"},
    {"local x = s.wait", "behaviors/test.lua:3: s has no 'wait'; the order is (m, s) in enter"},
    {"print(null)", "behaviors/test.lua:3: unknown name 'null': Lua writes nil"},
};

}  // namespace

TEST_CASE("a mistake is found when the file is loaded, with its line and a hint") {
  for (const Mistake& mistake : at_load) {
    const std::string message = load_error(mistake.text);
    INFO(mistake.text);
    INFO(message);
    CHECK(message.substr(0, mistake.message.size()) == mistake.message);
  }
}

TEST_CASE("a mistake in a tick stops the behavior with its line and a hint, and nothing of the tick is sent") {
  for (const Mistake& mistake : in_a_tick) {
    Stage stage(on_enter(mistake.text));
    stage.play(3);
    const std::string message = stage.behavior->error().text();
    INFO(mistake.text);
    INFO(message);
    CHECK(message.substr(0, mistake.message.size()) == mistake.message);
    CHECK(stage.applied.empty());
    CHECK(stage.behavior->outcome() == "error");
  }
}

TEST_CASE("all unknown states of a file are told at once") {
  const std::string message =
      load_error("local k = require 'kadans'\nreturn k.behavior 't' { k.state 'a' {\n{ to = 'b' },\n{ to = 'c' } } }");
  CHECK(message.find("behaviors/test.lua:3: unknown state 'b'") == 0);
  CHECK(message.find("\nbehaviors/test.lua:4: unknown state 'c'") != std::string::npos);
}

TEST_CASE("check_behavior tells what is wrong without running anything, and nothing of a good file") {
  const Robot robot;
  CHECK(check_behavior(KADANS_SOURCE_DIR, "behaviors/tulip/squat.lua", robot.catalog).empty());
  const auto missing = check_behavior(KADANS_SOURCE_DIR, "behaviors/tulip/none.lua", robot.catalog);
  REQUIRE(missing.size() == 1);
  CHECK(missing[0].text() == "behaviors/tulip/none.lua:1: there is no such file");
  const Scripts scripts;
  scripts.write("a.lua",
                "local k = require 'kadans' return k.behavior 'a' { enter = function() while true do end end,\nk.state "
                "'x' { endless = true } }");
  const auto endless = check_behavior(scripts.root, "a.lua", robot.catalog);  // a run would exceed its budget
  REQUIRE(endless.size() == 1);
  CHECK(endless[0].text().find("a.lua:1: this loop never ends") == 0);
}

}  // namespace mistake_test

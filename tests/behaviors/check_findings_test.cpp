// What behavior check finds beyond names: waits where nothing can wait, guards that return nothing, events that nobody
// emits, modules, vars. And what it must not find: charts that are odd, but right.
#include <algorithm>

#include <doctest/doctest.h>

#include "check_project.h"

using namespace kadans;
using namespace kadans::check_tests;

namespace {

const Case wrong[] = {
    {"m:wait in enter", "return k.behavior 't' { k.state 'a' { endless = true, enter = function(m)\nm:wait(1) end } }",
     "t.lua:3: a wait where 'enter' runs: only `run` can wait"},
    {"a motion's wait in during",
     "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true,\nduring = function(m)\n"
     "m.posture:move('stand', { time_s = 1 }):wait() end } }",
     "t.lua:4: a wait where 'during' runs"},
    {"a kept motion's wait in exit",
     "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, exit = function(m)\n"
     "local motion = m.posture:set('l_knee.position_rad', 0.1, { time_s = 1 })\nif m.time_s > 1 then\n"
     "motion:wait() end end } }",
     "t.lua:5: a wait where 'exit' runs"},
    {"a wait in the action of a transition",
     "return k.behavior 't' { k.state 'a' { { after = 1, to = 'a', action = function(m) m:wait(1) end } } }",
     "t.lua:2: a wait where 'action' runs"},
    {"a wait in what enter calls",
     "local function rest(m)\nreturn m:wait(1) end\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function(m) rest(m) end } }",
     "t.lua:3: a wait where 'enter' runs"},
    {"a wait in the function that enter is",
     "local function rest(m)\nm:wait(1) end\nreturn k.behavior 't' { k.state 'a' { endless = true, enter = rest } }",
     "t.lua:3: a wait where 'enter' runs"},
    {"a guard without return",
     "return k.behavior 't' { k.state 'a' {\n{ when = function(s) local up = s.time_s > 1 end, to = 'a' } } }",
     "t.lua:3: a guard that returns nothing is never true"},
    {"a guard that returns, but nothing",
     "return k.behavior 't' { k.state 'a' {\n{ when = function(s) if s.time_s > 1 then return end end, to = 'a' } } }",
     "t.lua:3: a guard that returns nothing is never true"},
    {"a guard by its name, whose inner function returns",
     "local function up(s)\nlocal function is() return true end\nlocal x = is() end\n"
     "return k.behavior 't' { k.state 'a' { { when = up, to = 'a' } } }",
     "t.lua:2: a guard that returns nothing is never true"},
    {"a guard of a module",
     "local arms = require 'arms'\nreturn k.behavior 't' { k.state 'a' { { when = arms.forgets, to = 'a' } } }",
     "behaviors/lib/arms.lua:6: a guard that returns nothing is never true"},
    {"an event that nobody emits",
     "return k.behavior 't' { initial = 'a', k.state 'a' { enter = function(m) m:emit 'seen' end,\n"
     "{ on = 'seen', to = 'b' } },\n"
     "k.state 'b' { { on = 'sean', to = 'a' } } }",
     "t.lua:4: nobody emits the event 'sean' here, did you mean 'seen'?"},
    {"an outcome that the call has not",
     "return k.behavior 't' { k.state 'a' { k.call 'over', { on = 'tirde', to = 'a' } } }",
     "t.lua:2: nobody emits the event 'tirde' here, did you mean 'tired'?"},
    {"an end that nothing inside has",
     "return k.behavior 't' { initial = 'o', k.state 'o' { k.state 'a' { endless = true },\n"
     "{ on = 'done', to = 'o' } } }",
     "t.lua:3: nothing in 'o' ends with 'done'"},
    {"the end of one region, waited for outside",
     "return k.behavior 't' { k.parallel 'p' { k.region 'x' { k.final 'e' { outcome = 'ok' } },\n"
     "k.region 'y' { k.state 's' { endless = true } }, { on = 'ok', to = 'p' } } }",
     "t.lua:3: nothing in 'p' ends with 'ok'"},
    {"done of regions of which one never is",
     "return k.behavior 't' { k.parallel 'p' { k.region 'x' { k.final 'e' { outcome = 'ok' } },\n"
     "k.region 'y' { k.final 'f' { outcome = 'done' } }, { on = 'done', to = 'p' }, { on = 'ok', to = 'p' } } }",
     "t.lua:3: nothing in 'p' ends with 'done'"},
    {"an end that is emitted",
     "return k.behavior 't' { initial = 'o', k.state 'o' { endless = true, enter = function(m)\n"
     "m:emit 'done' end, k.final 'x' { outcome = 'done' } } }",
     "t.lua:3: 'done' says how a state or a run ended, it cannot be emitted: give the event another name"},
    {"a pattern that is emitted",
     "return k.behavior 't' { k.state 'a' { enter = function(m)\nm:emit 'heat.*' end, { on = 'heat.*', after = 1, to = "
     "'a' } } }",
     "t.lua:3: 'heat.*' stands for several events: emit one of them"},
    {"a pattern that only '*' would take",
     "return k.behavior 't' { k.state 'a' { enter = function(m)\nm:emit 'heat.*' end, { on = '*', to = 'a' } } }",
     "t.lua:3: nothing in this behavior waits for the event 'heat.*'"},
    {"an event that is none of the emitted ones",
     "return k.behavior 't' { k.state 'a' { enter = function(m) m:emit(m.time_s > 1 and 'late' or 'soon') end,\n"
     "{ on = 'late', to = 'a' }, { on = 'never', to = 'a' }, { on = 'soon', to = 'a' } } }",
     "t.lua:3: nobody emits the event 'never' here; there is: late, soon"},
    {"a module without return",
     "local nothing = require 'nothing'\nreturn k.behavior 't' { k.state 'a' { endless = true,\n"
     "enter = function() nothing.f() end } }",
     "behaviors/lib/nothing.lua:3: returns nothing, and behaviors/t.lua:2 uses what it returns"},
    {"a function in vars",
     "return k.behavior 't' { vars = { n = 0,\nf = function() end }, k.state 'a' { endless = true } }",
     "t.lua:3: vars.f is a function: vars and args hold plain data"},
    {"a function deep in args",
     "return k.behavior 't' { args = { list = { { go =\nprint } } }, k.state 'a' { endless = true } }",
     "t.lua:2: args.list.go is a function"},
    {"a misspelt argument",
     "return k.behavior 't' { args = k.args { side = { 'left' } }, k.state 'a' { endless = true,\n"
     "enter = function(m) print(m.args.sied) end } }",
     "t.lua:3: m.args has no 'sied', did you mean 'side'?"},
    {"a misspelt argument of k.args",
     "local A = k.args { side = { 'left' } }\nreturn k.behavior 't' { k.state 'a' { endless = true,\n"
     "enter = function() print(A.side, A.sied) end } }",
     "t.lua:4: k.args has no 'sied', did you mean 'side'?"},
    {"a misspelt field of an event",
     "k.events { seen = { who = k.text } }\nreturn k.behavior 't' { k.state 'a' { endless = true,\n"
     "{ on = 'seen', to = 'a', action = function(_, s) print(s.event.data.woh) end } } }",
     "t.lua:4: no event here has the field 'woh', did you mean 'who'?"},
    {"a transition that an earlier one hides, by the same event",
     "k.events { go = { n = 'm' } }\nreturn k.behavior 't' { initial = 'a', k.state 'a' { endless = true,\n{ on = "
     "'go', to = 'b' },\n"
     "{ on = 'go', when = function(s) return s.event.data.n > 1 end, to = 'a' } }, k.state 'b' { endless = true } }",
     "t.lua:5: this transition is never taken: the one in line 4, to 'b', takes all that it could, and comes no later"},
    {"a transition that an earlier one hides, by the same time",
     "return k.behavior 't' { initial = 'a', k.state 'a' { { after = 1, to = 'b' },\n{ after = 2, to = 'a' } },\n"
     "k.state 'b' { { after = 2, to = 'a' }, { after = 1, to = 'b' } } }",
     "t.lua:3: this transition is never taken: the one in line 2, to 'b'"},
    {"a result that waits",
     "return k.behavior 't' { k.final 'a' { outcome = 'done', result = function(m)\nm:wait(1) return {} end } }",
     "t.lua:3: a wait where 'result' runs"},
    {"a report that is emitted",
     "return k.behavior 't' { k.state 'a' { enter = function(m)\nm:emit 'error' end, { on = 'error', after = 1, to = "
     "'a' } } }",
     "t.lua:3: 'error' reports what happened to the behavior, it cannot be emitted"},
    {"a misspelt name in a function that a call gives",
     "return k.behavior 't' { k.state 'a' { endless = true, k.call 'takes' {\nhow_m = function(_, s) return s.tiem_s "
     "end } "
     "} }",
     "t.lua:3: s has no 'tiem_s', did you mean 'time_s'?"},
    {"a parameter in vars",
     "local P = k.params { x = 1 }\nreturn k.behavior 't' { vars = {\nx = P.x }, k.state 'a' { endless = true } }",
     "t.lua:4: vars.x is a parameter, which is read where it is needed"},
    {"vars that hold themselves",
     "local v = {}\nv.v = v\nreturn k.behavior 't' { vars = v, k.state 'a' { endless = true } }", "t.lua:4: vars.v"},
    {"a function given to vars",
     "return k.behavior 't' { vars = { f = 0 }, k.state 'a' { endless = true, enter = function(m)\n"
     "m.vars.f = function() end end } }",
     "t.lua:3: m.vars.f is given a function: vars hold plain data"},
    {"a misspelt function of a module",
     "local arms = require 'arms'\nreturn k.behavior 't' { controls = 'posture', k.state 'a' { endless = true,\n"
     "enter = function(m) arms.rase(m) end } }",
     "t.lua:4: module 'arms' has no 'rase', did you mean 'raise'?"},
    {"a misspelt function that is handed on",
     "local arms = require(\"arms\")\nlocal lower =\narms.lowr\nreturn k.behavior 't' { k.state 'a' { endless = true,\n"
     "enter = lower } }",
     "t.lua:4: module 'arms' has no 'lowr', did you mean 'lower'?"},
    {"a misspelt function of Lua's own",
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function() print(string.fromat('x')) end } }",
     "t.lua:2: string has no 'fromat', did you mean 'format'?"},
    {"a misspelt guard of a module is nothing to ask",
     "local arms = require 'arms'\nreturn k.behavior 't' { k.state 'a' { endless = true, during = function()\n"
     "if arms:pu() then print(1) end end } }",
     "t.lua:4: module 'arms' has no 'pu'"},
};

const Case right[] = {
    {"an end of what is inside, waited for outside",
     "return k.behavior 't' { initial = 'o', k.state 'o' { k.state 'a' { k.final 'x' { outcome = 'ok' } },\n"
     "{ on = 'ok', to = 'o' } } }",
     ""},
    {"a wait in run, and in what it calls",
     "local function rest(m) m:wait(1) end\nreturn k.behavior 't' { controls = 'posture', k.state 'a' { endless = "
     "true,\n"
     "run = function(m) rest(m) m.posture:move('stand', { time_s = 1 }):wait() end } }",
     ""},
    {"a helper that waits when it is told to",
     "local function go(m, wait)\nlocal motion = m.posture:move('stand', { time_s = 1 })\n"
     "if wait then motion:wait() end\nend\n"
     "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true,\n"
     "enter = function(m) go(m, false) end, run = function(m) go(m, true) end } }",
     ""},
    {"a helper that comes back before it waits",
     "local function go(m, wait)\nlocal motion = m.posture:move('stand', { time_s = 1 })\n"
     "if not wait then return motion end\nreturn motion:wait()\nend\n"
     "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true,\n"
     "enter = function(m) go(m) end, run = function(m) go(m, true) end } }",
     ""},
    {"a helper that waits behind an and",
     "local function go(m, wait) local _ = wait and m:wait(1) end\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function(m) go(m) end } }",
     ""},
    {"something of one's own that waits",
     "local queue = { wait = function() end }\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function() queue:wait() queue.wait() end } }",
     ""},
    {"a function in enter that is run's",
     "local later\nreturn k.behavior 't' { k.state 'a' { endless = true,\n"
     "enter = function(m) later = function() m:wait(1) end end, run = function() later() end } }",
     ""},
    {"a motion that is started in enter and waited for in run",
     "local motion\nreturn k.behavior 't' { controls = 'posture', k.state 'a' { endless = true,\n"
     "enter = function(m) motion = m.posture:move('stand', { time_s = 1 }) end,\n"
     "run = function() motion:wait() end } }",
     ""},
    {"a guard that is a table of ways",
     "local function up(s)\nif s.time_s > 1 then return true elseif s.time_s > 2 then return false end end\n"
     "return k.behavior 't' { k.state 'a' { { when = up, to = 'a' } } }",
     ""},
    {"guards made by functions, and of modules",
     "local arms = require 'arms'\nlocal function after(t) return function(s) return s.time_s > t end end\n"
     "return k.behavior 't' { k.state 'a' { { when = after(1), to = 'a' }, { when = arms.up, to = 'a' },\n"
     "{ when = function(s) return arms.up(s) end, to = 'a' } } }",
     ""},
    {"a guard that is the tail of another, and one that loops",
     "local function is(s) return s.time_s > 1 end\n"
     "return k.behavior 't' { k.state 'a' { { when = function(s) do return is(s) end end, to = 'a' },\n"
     "{ when = function() for i = 1, 3 do if i == 2 then return true end end end, to = 'a' } } }",
     ""},
    {"an event by a name that only the run knows",
     "return k.behavior 't' { vars = { next = 'x' }, k.state 'a' { enter = function(m) m:emit(m.vars.next) end,\n"
     "{ on = 'x', to = 'a' }, { on = 'y', to = 'a' } } }",
     ""},
    {"events by a function, by a field, and put together",
     "return k.behavior 't' { initial = 'a', k.state 'a' { enter = function(m) m:emit('got:' .. m.name) end,\n"
     "{ on = 'got:t', to = 'b' } }, k.state 'b' { { on = 'got:x', to = 'a' } } }",
     ""},
    {"emit handed on",
     "local function tell(emit, m) emit(m, 'x') end\n"
     "return k.behavior 't' { k.state 'a' { enter = function(m) tell(m.emit, m) end, { on = 'x', to = 'a' } } }",
     ""},
    {"waiting for done and failed of a call that has neither",
     "return k.behavior 't' { k.state 'a' { k.call 'over', { on = 'done', to = 'a' }, { on = 'failed', to = 'a' },\n"
     "{ on = 'tired', to = 'a' } } }",
     ""},
    {"the outcome of regions together, one of them a call",
     "return k.behavior 't' { initial = 'p', k.parallel 'p' { k.region 'x' { k.final 'e' { outcome = 'ok' } },\n"
     "k.region 'y' { k.call 'over' }, { on = 'ok', to = 'p' }, { on = 'tired', to = 'p' } } }",
     ""},
    {"an event in always, emitted in another state",
     "return k.behavior 't' { initial = 'a', always = { { on = 'stop', to = 'b' } },\n"
     "k.state 'a' { during = function(m) if m.time_s > 1 then m:emit \"stop\" end end, { after = 9, to = 'a' } },\n"
     "k.state 'b' { endless = true } }",
     ""},
    {"modules that are data, functions, filled while they run, or fall back",
     "local arms, grows, back, number, call = require 'arms', require 'grows', require 'falls_back', require "
     "'number',\n"
     "require 'call'\nlocal g = require 'grows'\nlocal f = require 'falls_back'\nlocal n = require 'number'\n"
     "return k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, enter = function(m)\n"
     "g.put('x', 1) print(g.x, g.y, f.anything, n + 1, arms.count, back, number, grows) call(m) end } }",
     ""},
    {"a field that a function of the module, or somebody else, gives it",
     "local arms = require 'arms'\narms.mine = 1\nlocal function more(t) t.others = 2 end\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function()\n"
     "arms.learn() more(arms) print(arms.learnt, arms.mine, arms.others, arms['count']) end } }",
     ""},
    {"a module that is required for what it does",
     "require 'says'\nrequire(\"nothing\")\nreturn k.behavior 't' { k.state 'a' { endless = true } }", ""},
    {"vars of every plain kind",
     "return k.behavior 't' { vars = { a = 1, b = 'x', c = true, d = { 1, 2, { e = {} } }, [3] = 4 },\n"
     "args = { list = { {} } }, k.state 'a' { endless = true, enter = function(m) m.vars.a = (function() return 2 "
     "end)() "
     "end } }",
     ""},
    {"reports, arguments, results, and what a call gives",
     "local A = k.args { side = { 'left', one_of = { 'left', 'right' } } }\nlocal P = k.params { deep_m = { 1, min = "
     "0, max "
     "= 2 } }\n"
     "return k.behavior 't' { initial = 'a', always = { { on = 'error', to = 'b' } }, k.state 'a' {\n"
     "k.call 'takes' { how_m = P.deep_m, far_m = function(m, s) return s.time_s end },\n"
     "{ on = 'done', to = 'b', action = function(m, s) print(s.event.data.result.x, A.side, m.args.side) end },\n"
     "{ on = { 'refused', 'fault.motor_hot' }, to = 'b' } },\n"
     "k.final 'b' { outcome = 'done', result = function(m) return { side = A.side } end } }",
     ""},
    {"a chart made in a loop, with its functions in locals",
     "local states = { initial = 's1', controls = 'posture' }\nfor i = 1, 3 do\n"
     "local function enter(m) m.posture:set_gains(i > 1 and 'stiff' or 'soft') end\n"
     "states[i] = k.state('s' .. i) { enter = enter, { after = i, to = i < 3 and 's' .. i + 1 or 's1' } }\nend\n"
     "return k.behavior 't'(states)",
     ""},
    {"a key called when, enter or emit in tables of one's own",
     "local plan = { when = function() print 'x' end, enter = function(door) door:wait(1) end, emit = 'y', on = 'z' }\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = function() print(plan.on, plan.emit) end } }",
     ""},
};

}  // namespace

TEST_CASE("behavior check finds waits, guards, events, modules and vars that cannot be right") {
  const Project project;
  for (const Case& one : wrong) {
    CAPTURE(one.name);
    const std::string found = project.problems(one.chart);
    CAPTURE(found);
    CHECK(program::has(found, one.message));
    CHECK(std::count(found.begin(), found.end(), '\n') == 1);
  }
}

TEST_CASE("behavior check leaves alone what is odd, but right") {
  const Project project;
  for (const Case& one : right) {
    CAPTURE(one.name);
    const std::string found = project.problems(one.chart);
    CHECK(found == "");
  }
}

TEST_CASE("a module is checked by itself: what it returns, its names, its own modules") {
  const Project project;
  const CheckedScript good =
      project.script("behaviors/lib/good.lua",
                     "local arms = require 'arms'\nlocal good = {}\n"
                     "function good.go(m, s) m.anything:at_all(s.any.thing) arms.raise(m) end\nreturn good\n");
  CHECK(good.kind == ScriptKind::module);
  CHECK(Project::told(good.problems) == "");
  const auto problems = [&](const std::string& text) {
    return Project::told(project.script("behaviors/lib/bad.lua", text).problems);
  };
  CHECK(program::has(problems("local x = {}\n"), "bad.lua:1: returns nothing"));
  CHECK(program::has(problems("local x = {}\nfunction x.f() print(maths.pi) end\nreturn x\n"),
                     "bad.lua:2: unknown name 'maths', did you mean 'math'?"));
  CHECK(program::has(problems("local x = {}\nfunction x.f() count = 1 end\nreturn x\n"),
                     "bad.lua:2: 'count' would be a global"));
  CHECK(program::has(problems("local arms = require 'arms'\nreturn { f = function() arms.rise() end }\n"),
                     "bad.lua:2: module 'arms' has no 'rise', did you mean 'raise'?"));
  CHECK(program::has(problems("local k = require 'kadans'\nreturn { p = k.psoe }\n"), "bad.lua:2: "));
  CHECK(program::has(problems("return {\n"), "bad.lua:2: "));
  CHECK(program::has(problems("require 'nowhere'\nreturn {}\n"), "no module 'nowhere'"));
}

TEST_CASE("tests are checked by their name: expectations, behaviors, options, names, and nothing of them is run") {
  const Project project;
  project.problems("return k.behavior 't' { k.state 'a' { endless = true } }");  // behaviors/t.lua
  const CheckedScript good =
      project.script("behaviors/t_test.lua",
                     "local k = require 'kadans'\nlocal run = k.play('t.lua', { robot = 'config/tulip/robot.json' })\n"
                     "describe('t', function() before_each(function() error('not run') end)\n"
                     "it('is', function() expect(run.state):to_equal(1) expect(1).never.to_equal(2) expect "
                     "'x'.to_contain 'y' end) end)\n"
                     "print(run.joints.l_knee.position_rad, run:advance(1))\n");
  CHECK(good.kind == ScriptKind::test);
  CHECK(Project::told(good.problems) == "");
  const auto problems = [&](const std::string& text) {
    return Project::told(project.script("behaviors/bad_test.lua", "local k = require 'kadans'\n" + text).problems);
  };
  CHECK(program::has(problems("it('x', function()\nexpect(1).to_eqal(2) end)"),
                     "bad_test.lua:3: expect(...) has no 'to_eqal', did you mean 'to_equal'?"));
  CHECK(program::has(problems("it('x', function() expect(f(1, { 2 })).never.to_bee_near(2) end)"),
                     "has no 'to_bee_near'"));
  CHECK(program::has(problems("it('x', function()\nk.play 'nowhere.lua' end)"),
                     "bad_test.lua:3: k.play: there is no nowhere.lua"));
  CHECK(
      program::has(problems("it('x', function() k.play('t.lua', { robt = 'x' }) end)"), "k.play has no option 'robt'"));
  CHECK(program::has(problems("it('x', function() exepct(1) end)"), "unknown name 'exepct', did you mean 'expect'?"));
  CHECK(program::has(problems("it('x' function() end)"), "bad_test.lua:2: "));
}

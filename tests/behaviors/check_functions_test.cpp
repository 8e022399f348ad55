// Behavior check follows functions through tables, methods and modules of one's own: what it finds in a function that
// stands in a state it finds there too. And its hints for a module name fields of that module.
#include <algorithm>

#include <doctest/doctest.h>

#include "check_project.h"

using namespace kadans;
using namespace kadans::check_tests;

namespace {

void add_modules(const Project& project) {
  project.lib("moves",
              "local moves = {}\nfunction moves.rest(m)\nm:wait(1) end\nfunction moves:pause(m)\nm:wait(1) end\n"
              "moves.settle = function(m) moves.rest(m) end\nfunction moves.acts(m)\nm:emit 'seen' end\n"
              "function moves.counts()\nmoves.calls = 1 return true end\n"
              "function moves.later(m, wait) if wait then m:wait(1) end end\n"
              "function moves.go(m) return m.posture:move('stand', { time_s = 1 }) end\n"
              "function moves.lean(m)\nm.postur:move('stand', { time_s = 1 }) end\n"
              "function moves.tilted(s)\nreturn s.base.pitch > 1 end\n"
              "function moves.lost(s)\nlocal x = s.time_s > 1 end\n"
              "function moves.read(P) return P.hold_s end\n"
              "function moves:twice(m) self:pause(m) end\nreturn moves\n");
  project.lib("uses_moves",
              "local moves = require 'moves'\n"
              "return { rest = function(m) moves.rest(m) end, again = moves.rest }\n");
  project.lib("rest", "return function(m)\nm:wait(1) end\n");
  project.lib("queue", "local queue = {}\nfunction queue:wait() end\nfunction queue.rest(m) end\nreturn queue\n");
}

// A state whose enter is this body.
std::string enter(const std::string& before, const std::string& body) {
  return before +
         "\nreturn k.behavior 't' { controls = 'posture', k.state 'a' { endless = true, enter = function(m, s)\n" +
         body + "\nend } }";
}

// A state that is left by this guard, in a line of its own; it waits for 'seen'.
std::string guard(const std::string& before, const std::string& when) {
  return before +
         "\nreturn k.behavior 't' { k.state 'a' { enter = function(m) m:emit 'seen' end,"
         " { on = 'seen', after = 1, to = 'a' }, {\nwhen = " +
         when + ", to = 'a' } } }";
}

struct Text {
  std::string name;
  std::string chart;
  const char* message;
};

constexpr char waits_4[] = "t.lua:4: a wait where 'enter' runs";
constexpr char waits_3[] = "t.lua:3: a wait where 'enter' runs";
constexpr char waits_moves[] = "behaviors/lib/moves.lua:3: a wait where 'enter' runs";
constexpr char waits_method[] = "behaviors/lib/moves.lua:5: a wait where 'enter' runs";

const Text found_through[] = {
    {"a function of a table", enter("local M = {}\nfunction M.w(m)\nm:wait(1) end", "M.w(m)"), waits_4},
    {"a function given to a field", enter("local M = {}\nM.w = function(m)\nm:wait(1) end", "M.w(m)"), waits_4},
    {"a field by its text", enter("local M = {}\nM['w'] = function(m)\nm:wait(1) end", "M['w'](m)"), waits_4},
    {"a function in a table's braces", enter("local M = { 1, w = function(m)\nm:wait(1) end }", "M.w(m)"), waits_3},
    {"a key in brackets", enter("local M = { ['w'] = function(m)\nm:wait(1) end }", "M.w(m)"), waits_3},
    {"a local function that is a field", enter("local function w(m)\nm:wait(1) end local M = { w = w }", "M.w(m)"),
     waits_3},
    {"a table in a table", enter("local M = { arms = {} }\nfunction M.arms.w(m)\nm:wait(1) end", "M.arms.w(m)"),
     waits_4},
    {"a table behind setmetatable", enter("local M = setmetatable({}, {})\nfunction M.w(m)\nm:wait(1) end", "M.w(m)"),
     waits_4},
    {"a method", enter("local M = {}\nfunction M:w(m)\nm:wait(1) end", "M:w(m)"), waits_4},
    {"a method called by a dot", enter("local M = {}\nfunction M:w(m)\nm:wait(1) end", "M.w(M, m)"), waits_4},
    {"a function called by a colon", enter("local M = {}\nfunction M.w(_, m)\nm:wait(1) end", "M:w(m)"), waits_4},
    {"a method of self", enter("local M = {} function M:a(m) self:b(m) end\nfunction M:b(m)\nm:wait(1) end", "M:a(m)"),
     waits_4},
    {"a field by another name", enter("local M = {}\nfunction M.w(m)\nm:wait(1) end local N = M local w = N.w", "w(m)"),
     waits_4},
    {"a function declared before",
     enter("local w local function go(m) w(m) end\nfunction w(m)\nm:wait(1) end", "go(m)"), waits_4},
    {"a table declared before", enter("local M\nM = { w = function(m)\nm:wait(1) end }", "M.w(m)"), waits_4},
    {"a motion kept in a table",
     enter("local M = {}", "M.motion = m.posture:move('stand', { time_s = 1 })\nM.motion:wait()"),
     "t.lua:5: a wait where 'enter' runs"},
    {"m kept in a table", enter("local M = {}", "M.m = m\nM.m:wait(1)"), "t.lua:5: a wait where 'enter' runs"},
    {"enter is a function of a table",
     "local M = {}\nfunction M.w(m)\nm:wait(1) end\nreturn k.behavior 't' { k.state 'a' { endless = true, enter = M.w "
     "} }",
     waits_4},
    {"enter is given to a state's table",
     "local a = { endless = true }\na.enter = function(m)\nm:wait(1) end\nreturn k.behavior 't' { k.state 'a' (a) }",
     waits_4},
    {"enter is made by a function",
     "local function make()\nreturn function(m)\nm:wait(1) end end\n"
     "return k.behavior 't' { k.state 'a' { endless = true, enter = make() } }",
     waits_4},
    {"a module", enter("local mine = require 'moves'", "mine.rest(m)"), waits_moves},
    {"one of two modules", enter("local arms, mine = require 'arms', require 'moves'", "mine.rest(m) print(arms)"),
     waits_moves},
    {"a name behind a function, which it does not know",
     enter("local one, w = function() return #{ 1, 2 } end, function(m)\nm:wait(1) end\nprint(one)", "w(m)"), waits_3},
    {"a local that its own function does not see", enter("", "local again = function()\nagain() end again()"),
     "t.lua:5: unknown name 'again'"},
    {"a module in brackets", enter("local mine = require(\"moves\")", "mine.rest(m)"), waits_moves},
    {"a module without a name", enter("require 'moves'", "require 'moves'.rest(m)"), waits_moves},
    {"a field of a module", enter("local rest = require('moves').rest", "rest(m)"), waits_moves},
    {"a module's function that calls another", enter("local mine = require 'moves'", "mine.settle(m)"), waits_moves},
    {"a module's method", enter("local mine = require 'moves'", "mine:pause(m)"), waits_method},
    {"a module's method that calls another", enter("local mine = require 'moves'", "mine:twice(m)"), waits_method},
    {"a module of a module", enter("local mine = require 'uses_moves'", "mine.rest(m)"), waits_moves},
    {"a module that hands on", enter("local mine = require 'uses_moves'", "mine.again(m)"), waits_moves},
    {"a module that is a function", enter("local rest = require 'rest'", "rest(m)"),
     "behaviors/lib/rest.lua:2: a wait where 'enter' runs"},
    {"a module in a table", enter("local lib = { moves = require 'moves' }", "lib.moves.rest(m)"), waits_moves},
    {"a function given to a module",
     enter("local arms = require 'arms'\nfunction arms.w(m)\nm:wait(1) end", "arms.w(m)"), waits_4},
    {"enter is a module's function",
     "local moves = require 'moves'\nreturn k.behavior 't' { k.state 'a' { endless = true, enter = moves.rest } }",
     waits_moves},
    {"a guard that acts in a table",
     guard("local M = {}\nfunction M.acts(m)\nm:emit 'seen' end", "function(_, m) M.acts(m) return true end"),
     "t.lua:4: a guard acts: 'emit' belongs into"},
    {"a guard that acts in a module",
     guard("local moves = require 'moves'", "function(_, m) moves.acts(m) return true end"),
     "moves.lua:8: a guard acts: 'emit' belongs into"},
    {"a guard that writes in a table",
     guard("local M = {}\nfunction M.n()\nM.count = 1 return true end", "function() return M.n() end"),
     "t.lua:4: a guard writes: 'M' must not change"},
    {"a guard that writes in a module", guard("local moves = require 'moves'", "moves.counts"),
     "moves.lua:10: a guard writes: 'moves' must not change"},
    {"a guard that returns what returns nothing",
     guard("local function lost(s) local x = s.time_s > 1 end", "function(s) return lost(s) end"),
     "t.lua:4: a guard that returns nothing is never true"},
    {"a guard that returns what a table's function forgets",
     guard("local M = {} function M.lost(s) local x = s.time_s > 1 end", "function(s) return M.lost(s) end"),
     "t.lua:4: a guard that returns nothing is never true"},
    {"a guard that returns what a module's function forgets",
     guard("local moves = require 'moves'", "function(s) return moves.lost(s) end"),
     "t.lua:4: a guard that returns nothing is never true"},
    {"a guard that is a table's function, which forgets", guard("local M = {}\nfunction M.lost(s) end", "M.lost"),
     "t.lua:3: a guard that returns nothing is never true"},
    {"an event that nobody waits for, in a module", enter("local moves = require 'moves'", "moves.acts(m)"),
     "moves.lua:8: nothing in this behavior waits for the event 'seen'"},
    {"an unknown object in a module", enter("local moves = require 'moves'", "moves.lean(m)"),
     "moves.lua:14: m has no 'postur', did you mean 'posture'?"},
    {"an unknown field of s in a module", guard("local moves = require 'moves'", "moves.tilted"),
     "moves.lua:16: s.base has no 'pitch', did you mean 'pitch_rad'?"},
    {"a misspelt function of a module without a name", enter("require 'arms'", "require('arms').rase(m)"),
     "t.lua:4: module 'arms' has no 'rase', did you mean 'raise'?"},
    {"a name that only another table has",
     enter("local arms = require 'arms' local plan = {}", "plan.rase = 1\narms.rase(m)"),
     "t.lua:5: module 'arms' has no 'rase', did you mean 'raise'?"},
    {"a name by its text that the module has not", enter("local arms = require 'arms'", "arms['rase'](m)"),
     "t.lua:4: module 'arms' has no 'rase', did you mean 'raise'?"},
    {"a hint is of the module, not of a table that is nearer",
     enter("local arms = require 'arms' local plan = {}", "plan.raaze = 1\narms.raize(m)"),
     "t.lua:5: module 'arms' has no 'raize', did you mean 'raise'?"},
    {"all names of a module, and no others",
     enter("local arms = require 'arms' local plan = {}", "plan.other = 1 arms.mine = 1\narms.zzzzzzzz(m)"),
     "t.lua:5: module 'arms' has no 'zzzzzzzz'; there is: count, forgets, learn, learnt, lower, mine, raise, up"},
};

const Text left_alone[] = {
    {"waits of tables and modules in run",
     "local M, moves = {}, nil\nlocal mine = require 'moves'\nfunction M.w(m) m:wait(1) end\n"
     "return k.behavior 't' { k.state 'a' { endless = true, run = function(m) M.w(m) mine.rest(m) mine:pause(m)\n"
     "require 'rest'(m) end } }",
     ""},
    {"a module's helper that waits when it is told to", enter("local moves = require 'moves'", "moves.later(m, false)"),
     ""},
    {"a module's helper that starts a motion", enter("local moves = require 'moves'", "moves.go(m)"), ""},
    {"tables with fields of one name",
     enter("local A, B = {}, {}\nlocal C = {} local D = {}\n"
           "function C.w(m) m:wait(1) end function D.w() end",
           "D.w(m) print(C, A, B)"),
     ""},
    {"modules with fields of one name",
     enter("local moves = require 'moves'\nlocal queue = require 'queue'", "queue.rest(m) queue:wait() print(moves)"),
     ""},
    {"a function that is replaced",
     enter("local M = {}\nfunction M.w(m) m:wait(1) end\nM.w = function() end", "M.w(m)"), ""},
    {"a local that is replaced", enter("local w = function(m) m:wait(1) end\nw = function() end", "w(m)"), ""},
    {"a table that is replaced",
     enter("local M = { w = function(m) m:wait(1) end }\nif k then M = { w = function() end } end", "M.w(m)"), ""},
    {"a table of which nothing is known",
     enter("local M = { w = function(m) m:wait(1) end }\nM = select(1, {})", "M.w(m)"), ""},
    {"names that are swapped",
     enter("local v, w = nil, nil\nlocal x = function(m) m:wait(1) end\nx, v = v, x", "print(v, w) x(m)"), ""},
    {"a parameter of a table's name",
     enter("local M = {}\nfunction M.w(m) m:wait(1) end\n"
           "local function go(M, m) M.w(m) end",
           "go({ w = print }, m)"),
     ""},
    {"objects kept in tables and locals",
     enter("local M = {}",
           "M.posture = m.posture M.posture = m.posture\nlocal p = m.posture p = m.posture\n"
           "p:set_gains 'soft' M.posture:set_gains 'soft'"),
     ""},
    {"functions of one's own under keys of a state",
     enter("local ops = {\nenter = function(m, wait) if wait then m:wait(1) end end,\n"
           "run = function(door) door:wait(1) door:open() end,\nwhen = function(door) door.tries = 1 end }",
           "ops.enter(m, false) ops.run(select(1, {})) ops.when({})"),
     ""},
    {"a function that waits for what it is given",
     "local queue = { wait = function() end }\nlocal function go(x) x:wait(1) end\n"
     "return k.behavior 't' { k.state 'a' { endless = true,\nenter = function() go(queue) end,\n"
     "run = function(m) go(m) end } }",
     ""},
    {"locals named after what they are made of",
     enter("",
           "local m, s, t = m.posture, s.base, -s.time_s local t = t\nm:set_gains 'soft' print(s.pitch_rad, t)\n"
           "local s = s.pitch_rad local f, n = function(s) return s end, s; print(f(n))"),
     ""},
    {"guards that ask tables and modules",
     guard("local M = { n = 1 }\nfunction M.up(s) return s.time_s > M.n end local arms = require 'arms'",
           "function(s) return M.up(s) or arms.up(s) end"),
     ""},
    {"a guard that returns a function's value",
     guard("local arms = require 'arms'", "function(s) return arms.up(s) end"), ""},
    {"a guard that returns what is made while it runs",
     guard("local M = {}\nM.up = select(1, {}) or print", "function(s) return M.up(s) end"), ""},
    {"parameters handed to a module",
     "local P = k.params { hold_s = 1 }\nlocal moves = require 'moves'\n"
     "return k.behavior 't' { k.state 'a' { endless = true, run = function(m) m:wait(moves.read(P)) end } }",
     ""},
    {"fields that a module is given in every way",
     enter("local arms = require 'arms'\nlocal function more(t) t.a = 1 end\nmore(arms) arms.b, arms.c = 1, 2\n"
           "for _, t in ipairs { arms } do t.d = 1 end\nlocal all = { arms } all[1].e = 1\nrequire('arms').f = 1",
           "print(arms.a, arms.b, arms.c, arms.d, arms.e, arms.f)"),
     ""},
    {"tables that hold one another",
     enter("local C = {} local D = {}\nlocal function never() C.d = D.c D.c = C.d C.x = C.x C.y = C.y.z end",
           "C.d(m) D.c(m) C.x(m) C.y(m) print(never)"),
     ""},
    {"functions that call each other, in a table and a module",
     enter("local moves = require 'moves' local M = {}\nfunction M.a(m) return M.b(m) end\n"
           "function M.b(m) if m.time_s > 9 then return moves.go(m) end return M.a(m) end",
           "M.a(m)"),
     ""},
};

void compare(const Project& project, const Text& one) {
  CAPTURE(one.name);
  const std::string found = project.problems(one.chart);
  CAPTURE(found);
  if (one.message[0] == '\0') {
    CHECK(found == "");
  } else {
    CHECK(program::has(found, one.message));
    CHECK(std::count(found.begin(), found.end(), '\n') == 1);
  }
}

}  // namespace

TEST_CASE("behavior check finds through tables, methods and modules what it finds in a state's own function") {
  const Project project;
  add_modules(project);
  for (const Text& one : found_through) compare(project, one);
}

TEST_CASE("behavior check follows no function that another value may stand for") {
  const Project project;
  add_modules(project);
  for (const Text& one : left_alone) compare(project, one);
}

TEST_CASE("Functions that return one another's values in very many ways are looked through once each") {
  const Project project;
  constexpr int layers = 14, width = 6;  // 6^14 ways
  std::string before = "local M = {}";
  for (int layer = 0; layer < layers; ++layer) {
    for (int i = 0; i < width; ++i) {
      before += " function M.f" + std::to_string(layer) + "_" + std::to_string(i) + "(s)";
      for (int next = 0; next < width && layer + 1 < layers; ++next)
        before += " if s.time_s > " + std::to_string(next) + " then return M.f" + std::to_string(layer + 1) + "_" +
                  std::to_string(next) + "(s) end";
      before += " end";
    }
  }
  CHECK(program::has(project.problems(guard(before, "function(s) return M.f0_0(s) end")),
                     "a guard that returns nothing is never true"));
}

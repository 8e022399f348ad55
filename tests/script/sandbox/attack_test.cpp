// Attacks on the budgets: each must end, stop its behavior with a line, and leave the others alone.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

struct Attack {
  std::string name;
  std::string code;  // on entering a state
  ScriptBreach breach;
};

constexpr ScriptBreach time_out = ScriptBreach::instructions;
constexpr ScriptBreach memory = ScriptBreach::memory;

const Attack attacks[] = {
    {"an endless loop", "while true do end", time_out},
    {"a loop around pcall", "while true do pcall(function() while true do end end) end", time_out},
    {"pcall in pcall in pcall", "local function f() pcall(f) while true do pcall(f) end end f()", time_out},
    {"a loop around xpcall", "while true do xpcall(function() while true do end end, function() end) end", time_out},
    {"an xpcall handler that loops", "xpcall(error, function() while true do end end)", time_out},
    {"an xpcall handler that raises", "local function h() error('x') end while true do pcall(xpcall, error, h) end",
     time_out},
    {"a loop in a coroutine", "coroutine.wrap(function() while true do end end)()", time_out},
    {"coroutines resumed in a loop",
     "while true do coroutine.resume(coroutine.create(function() while true do end end)) end", time_out},
    {"coroutines within coroutines, again and again",
     "local function f() return coroutine.wrap(f)() end while true do pcall(f) end", time_out},
    {"a yield in a loop",
     "local c = coroutine.wrap(function() while true do coroutine.yield() end end) while true do c() end", time_out},
    {"recursion without end", "local function f() return 1 + f() end while true do pcall(f) end", time_out},
    {"tail calls without end", "local function f() return f() end f()", time_out},
    {"a goto loop", "::top:: goto top", time_out},
    {"string.rep in a loop", "local t = {} while true do t[#t + 1] = ('x'):rep(60000) .. #t end", time_out},
    {"a string that doubles", "local x = 'x' while true do x = x .. x end", memory},
    {"a string that doubles under pcall", "local x = 'x' while true do pcall(function() x = x .. x end) end", memory},
    {"a table that grows", "local t = {} for i = 1, 1e9 do t[i] = i end", memory},
    {"a table that grows under pcall", "local t = {} while true do pcall(function() t[#t + 1] = {} end) end", time_out},
    {"a hash that grows", "local t = {} local i = 0 while true do i = i + 1 t['k' .. i] = i end", memory},
    {"closures without end", "local f = print while true do local g = f f = function() return g end end", memory},
    {"table.concat of what is large",
     "local t = {} for i = 1, 1000 do t[i] = ('x'):rep(60) end\n"
     "local u = {} while true do u[#u + 1] = table.concat(t) end",
     time_out},
    {"a pattern that backtracks, again and again", "local x = ('a'):rep(100) while true do x:find('(.-)(.-)b') end",
     time_out},
    {"a gsub callback that loops", "('x'):gsub('.', function() while true do end end)", time_out},
    {"gsub of a long string", "local x = ('x'):rep(60000) while true do x:gsub('x', 'y') end", time_out},
    {"a gmatch without end", "for _ in ('x'):rep(60000):gmatch('') do while true do end end", time_out},
    {"a comparison that loops", "table.sort({ 1, 2, 3 }, function() while true do end end)", time_out},
    {"pcall as comparison",
     "local t = {} for i = 1, 1000 do t[i] = function() while true do end end end table.sort(t, pcall)", time_out},
    {"a large sort, again and again", "local t = {} for i = 1, 5000 do t[i] = -i end while true do table.sort(t) end",
     time_out},
    {"insertions at the front",
     "local t = {} for i = 1, 5000 do t[i] = i end while true do table.insert(t, 1, 0) table.remove(t, 1) end",
     time_out},
    {"pairs over a large table", "local t = {} for i = 1, 5000 do t[i] = i end while true do pairs(t) end", time_out},
    {"load in a loop", "local x = ('x=1 '):rep(1000) while true do load(x) end", time_out},
    {"an __index that loops", "local t = setmetatable({}, { __index = function() while true do end end }) return t.x",
     time_out},
    {"an __index that calls itself",
     "local t t = setmetatable({}, { __index = function(_, key) return t[key] end }) while true do pcall(function() "
     "return t.x end) end",
     time_out},
    {"a tostring that loops", "print(setmetatable({}, { __tostring = function() while true do end end }))", time_out},
    {"a __lt that loops",
     "local mt = { __lt = function() while true do end end }\n"
     "table.sort({ setmetatable({}, mt), setmetatable({}, mt) })",
     time_out},
    {"a chain of __index without end", "local t = {} while true do t = setmetatable({}, { __index = t }) end", memory},
    {"a __newindex that calls itself",
     "local t t = setmetatable({}, { __newindex = function(_, key) t[key] = 1 end })\n"
     "while true do pcall(function() t.x = 1 end) end",
     time_out},
    {"a __concat, an __eq and a __call that loop",
     "local mt = {} mt.__concat = function() while true do end end mt.__eq = mt.__concat mt.__call = mt.__concat\n"
     "local a, b = setmetatable({}, mt), setmetatable({}, mt)\n"
     "while true do pcall(function() return a == b end) pcall(a) pcall(function() return a .. b end) end",
     time_out},
    {"errors that are tables, again and again", "while true do pcall(error, { {} }) end", time_out},
    {"an error whose tostring loops",
     "local _, e = pcall(error, setmetatable({}, { __tostring = function() while true do end end })) print(e)",
     time_out},
    {"garbage whose __gc would loop", "while true do setmetatable({}, { __gc = function() while true do end end }) end",
     memory},
    {"a coroutine that catches its own end",
     "local f = coroutine.wrap(function() while true do pcall(function() while true do end end) end end) f()",
     time_out},
    {"a coroutine that is resumed within a pcall, within a coroutine",
     "local function f() while true do coroutine.resume(coroutine.create(function() pcall(error, 1) end)) end end\n"
     "pcall(coroutine.wrap(f))",
     time_out},
    {"a format of what is long, always the same",
     "local x = ('x'):rep(9000) while true do local y = ('%s%s%s%s%s%s'):format(x, x, x, x, x, x) end", time_out},
    {"a long string turned round, cut, spelt and read as a number, always the same",
     "local x = ('1'):rep(60000) while true do x:reverse() x:upper() x:lower() x:sub(2) x:byte(1, 5000) tonumber(x) "
     "end",
     time_out},
    {"a long string joined to itself, always the same", "local x = ('x'):rep(30000) while true do local y = x .. x end",
     time_out},
    {"digits as numbers", "local x = ('1'):rep(4000) while true do local y = x + 0 end", time_out},
    {"a table unpacked without end", "local t = {} for i = 1, 5000 do t[i] = i end while true do unpack(t) end",
     time_out},
    {"arguments that grow", "local function f(...) return f(1, ...) end while true do pcall(f) end", time_out},
    {"a random pose a thousand times", "while true do pcall(m.posture.move, m.posture, 'stand', { time_s = 1 }) end",
     time_out},
    {"the queue flooded", "while true do m.posture:set_gains('stiff') end", time_out},
    {"the event queue flooded", "while true do pcall(m.emit, m, 'x') end", time_out},
    {"vars that grow", "while true do m.vars[#m.vars + 1] = { {}, {}, {}, {} } end", memory},
    {"printing without end", "while true do print('x') end", time_out},
    {"a random number without end", "while true do math.random() end", time_out},
};

}  // namespace

TEST_CASE("every attack is stopped by its budget, with the script's line") {
  for (const Attack& attack : attacks) {
    CAPTURE(attack.name);
    Stage stage(on_enter(attack.code));
    stage.play(5);
    CHECK(stage.behavior->failed());
    CHECK(stage.behavior->outcome() == "error");
    const ScriptError& error = stage.behavior->error();
    INFO(error.text());
    // Where values are half as large, a tick may be over before the memory is full.
    const bool small = sizeof(void*) == 4 && attack.breach == memory && error.breach == time_out;
    CHECK((small || error.breach == attack.breach));
    CHECK(std::string(error.file.data()) == "behaviors/test.lua");
    CHECK(error.line >= 3);
    CHECK(stage.behavior->heap_bytes() < 5u << 20);
    CHECK(stage.applied.empty());
  }
}

namespace {

// Moves, tells, takes transitions and random numbers: whatever disturbs it would show.
const char neighbour[] = R"(local k = require 'kadans'
return k.behavior 'neighbour' { controls = 'posture', vars = { n = 0 }, initial = 'a',
  k.state 'a' { during = function(m, s) m.vars.n = m.vars.n + 1 print(s.time_s, m.vars.n, math.random(1000)) end,
    run = function(m) print(m.posture:move({ l_knee = math.random() }, { time_s = 0.02 }):wait()) end,
    { on = 'run.done', to = 'b' } },
  k.state 'b' { { after = 0.01, to = 'a' } } })";

struct Heard {
  std::vector<std::string> messages, transitions;
  std::vector<double> commands;
  bool operator==(const Heard&) const = default;
};

// What is heard of the neighbour when it plays alone, or behind or before a behavior that attacks after three ticks.
Heard beside(const std::string& attack, bool first) {
  Stage stage(neighbour);
  std::unique_ptr<Behavior> attacker;
  Log silent;
  if (!attack.empty()) {
    const auto file = stage.scripts.write(
        "behaviors/attacker.lua",
        "local k = require 'kadans'\nreturn k.behavior 'attacker' { initial = 'w', k.state 'w' { { after = 0.03, to = "
        "'a' } }, k.state 'a' { enter = function(m, s)\n" +
            attack + "\nend } }\n");
    attacker = std::make_unique<Behavior>(Behavior::Settings{.root = stage.scripts.root, .file = file},
                                          stage.robot.catalog, silent);
  }
  for (int i = 0; i < 12; ++i) {
    if (attacker && first) (void)attacker->tick(stage.snapshot, stage.sender);
    const Snapshot seen = stage.snapshot;
    CHECK(stage.tick());
    if (attacker && !first) (void)attacker->tick(seen, stage.sender);
  }
  if (attacker) CHECK(attacker->failed());
  Heard heard{stage.log.messages, stage.log.transitions, {}};
  for (const Command& command : stage.applied)
    heard.commands.insert(heard.commands.end(), {command.value, double(command.index), double(command.sequence)});
  return heard;
}

}  // namespace

TEST_CASE("no attack changes what a behavior beside it says, does and commands") {
  const Heard alone = beside("", false);
  REQUIRE(alone.transitions.size() >= 4);
  REQUIRE(alone.commands.size() >= 12);
  for (const Attack& attack : attacks) {
    CAPTURE(attack.name);
    CHECK(beside(attack.code, true) == alone);
    CHECK(beside(attack.code, false) == alone);
  }
}

TEST_CASE("an endless loop is stopped wherever a script can put it") {
  const std::string loop = "while true do end";
  const std::string head = "local k = require 'kadans' return k.behavior 'test' { ";
  for (const std::string& text : {
           head + "enter = function() " + loop + " end, k.state 'a' {} }",
           head + "k.state 'a' { enter = function() " + loop + " end } }",
           head + "k.state 'a' { during = function() " + loop + " end } }",
           head + "k.state 'a' { run = function() " + loop + " end } }",
           head + "initial = 'a', k.state 'a' { exit = function() " + loop +
               " end, { after = 0, to = 'b' } }, k.state 'b' {} }",
           head + "initial = 'a', k.state 'a' { { when = function() " + loop + " end, to = 'b' } }, k.state 'b' {} }",
           head + "initial = 'a', k.state 'a' { { action = function() " + loop + " end, to = 'b' } }, k.state 'b' {} }",
           head + "initial = 'a', always = { { when = function() " + loop +
               " end, to = 'b' } }, k.state 'a' {}, k.state 'b' {} }",
           head + "k.final 'a' { enter = function() " + loop + " end } }",
           head + "k.state 'a' { run = function(m) m:wait(0) pcall(function() " + loop + " end) end } }",
       }) {
    CAPTURE(text);
    Stage stage(text);
    stage.play(10);
    CHECK(stage.behavior->error().breach == ScriptBreach::instructions);
    CHECK(stage.behavior->error().text().find("behaviors/test.lua:1: instruction budget exceeded") == 0);
  }
}

TEST_CASE("an endless loop at the top of a file is a mistake of that file") {
  CHECK(load_error("local x\nwhile true do end").find("behaviors/test.lua:2: instruction budget exceeded") == 0);
  CHECK(load_error("local t = {}\nwhile true do t[#t + 1] = {} end").find("behaviors/test.lua:2: out of memory") == 0);
}

TEST_CASE("what no budget can hold is refused at the line") {
  const auto refused = [](const std::string& code, const char* why) {
    CAPTURE(code);
    const std::string text = output_of(code);
    CHECK_MESSAGE(text.find(why) != std::string::npos, text);
    CHECK_MESSAGE(text.find("behaviors/test.lua:3:") != std::string::npos, text);
  };
  refused("local x = ('x'):rep(1e9)", "at most 64 kB");
  refused("return (''):rep(1e9) .. nil", "nil");
  refused("local function f() return (('x'):gsub('x', f)) end return f() .. nil", "nested too deeply");
  refused("local function f(a, b) table.sort({ 1, 2 }, f) return false end f()", "nested too deeply");
  refused(
      "local t = setmetatable({}, { __tostring = function(t) return ('%s'):format(t) end }) local x = ('%s'):format(t)",
      "nested too deeply");
  refused("print(setmetatable({}, { __tostring = function(t) print(t) return '' end }))", "nested too deeply");
  refused("print(tostring(setmetatable({}, { __tostring = function(t) return tostring(t) .. '' end })))",
          "nested too deeply");
  refused(
      "local t t = setmetatable({}, { __index = function() m.posture:move(t, { time_s = 1 }) end })\n"
      "m.posture:move(t, { time_s = 1 })",
      "nested too deeply");
  refused("local function f() return (coroutine.wrap(f)()) end f()", "coroutines resume one another too deeply");
  refused("local x = ('%-5p'):format(print)", "string.format has no %p");
  refused("local x = ('\\0%p'):format(print)", "string.format has no %p");
  refused("local x = (('('):rep(100) .. ('a'):rep(100)):find(('('):rep(100))", "too many captures");
  refused("local t = {} for i = 1, 9000 do t[i] = i end print(unpack(t))", "too many results");
}

TEST_CASE("a string has at most 64 kB, however it is made") {
  for (const char* code :
       {"local x = ('x'):rep(60000) x = x .. x", "local x = ('x'):rep(60000) x = ('%s%s'):format(x, x)",
        "local x = ('x'):rep(60000) x = table.concat { x, x }", "local x = ('x'):rep(60000) x = x:gsub('^x', x)"}) {
    CAPTURE(code);
    CHECK(output_of(code).find("behaviors/test.lua:3: out of memory") == 0);
  }
}

TEST_CASE("an error in a tail call, which leaves no trace, is reported where its function begins") {
  CHECK(output_of("return ('x'):rep(1e9)").find("behaviors/test.lua:2: string.rep makes") == 0);
}

TEST_CASE("a wall-time budget stops what instructions alone would let pass") {
  ScriptLimits limits;
  limits.tick_instructions = 1'000'000'000'000;
  limits.tick_wall_ns = 2'000'000;
  Stage stage(on_enter("while true do end"), limits);
  stage.tick();
  CHECK(stage.behavior->error().breach == ScriptBreach::wall_time);
}

TEST_CASE("k.budget tells what is left") {
  Stage stage(
      on_enter("local k = require 'kadans' local a = k.budget() for i = 1, 20000 do end local b = k.budget()\n"
               "print(a.instructions - b.instructions >= 19000, a.memory_bytes > 3e6, a.memory_bytes < 4.2e6)"));
  stage.tick();
  CHECK(stage.said() == "true true true\n");
}

TEST_CASE("a behavior that nearly fills its memory lives on where time is limited, collected piece by piece") {
  Stage stage(
      "local k = require 'kadans' local kept = {} for i = 1, 30000 do kept[i] = { i } end\n"
      "return k.behavior 'test' { k.state 'a' { during = function(m)\n"
      "for i = 1, 300 do kept[math.random(#kept)] = { i } end end } }",
      {.tick_wall_ns = 5'000'000, .load_wall_ns = 1'000'000'000});
  stage.tick(700);
  INFO(stage.behavior->error().text());
  CHECK_FALSE(stage.behavior->failed());
  CHECK(stage.behavior->heap_bytes() > (sizeof(void*) == 8 ? 5u << 19 : 4u << 19));
}

TEST_CASE("garbage is collected between ticks, so that a behavior lives within its memory for ever") {
  Stage stage(
      "local k = require 'kadans' return k.behavior 'test' { k.state 'a' { during = function(m)\n"
      "local t = {} for i = 1, 200 do t[i] = { i } end m.vars.t = t end } }");
  stage.tick(20000);
  CHECK_FALSE(stage.behavior->failed());
  CHECK(stage.behavior->heap_bytes() < 1u << 20);
}

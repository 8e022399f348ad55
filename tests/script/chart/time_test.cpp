// Scripts are held in by time too: whatever works long in C counts its own steps, and what cannot be counted is ended
// by the clock.
#include <doctest/doctest.h>
#include <lua.hpp>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"
#include "script/lua/budget.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

// How the behavior that runs `code` on entering its state ends.
ScriptError end_of(const std::string& code, const ScriptLimits& limits = {}) {
  Stage stage(on_enter(code), limits);
  stage.play(3);
  return stage.behavior->error();
}

// As in `kadans run` with 2 ms, and instructions enough for seconds.
constexpr ScriptLimits on_wall_clock{.tick_instructions = 1'000'000'000'000,
                                     .load_instructions = 1'000'000'000'000,
                                     .tick_wall_ns = 2'000'000,
                                     .load_wall_ns = 10'000'000};

// From here on somebody wants the program to end.
struct Interruption {
  Interruption() { interrupt_scripts(); }
  ~Interruption() { interrupt_scripts(false); }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;
};

}  // namespace

TEST_CASE("a pattern of which nobody can say beforehand how long it takes is stopped in the middle") {
  for (const char* code : {
           "local x = ('[x' .. ('a'):rep(300)):find('^%b[x.-.-.-.-.-.-.-c')",
           "local x = (('^'):rep(60000)):gmatch('^.-b')()",
           "local x = (('a'):rep(60000)):find('.-.-.-b')",
           "local x = (('a'):rep(40)):find(('a?'):rep(40) .. ('a'):rep(40))",
           "local x = (('('):rep(60000)):gsub('%b()', '')",
           "local x = (('a'):rep(60000)):find('(.*)%1b')",
       }) {
    CAPTURE(std::string(code));
    const ScriptError error = end_of(code);
    CHECK(error.breach == ScriptBreach::instructions);
    CHECK(error.text().find("behaviors/test.lua:3: instruction budget exceeded") == 0);
  }
}

TEST_CASE("an insertion far below a table is stopped by its budget") {
  CHECK(end_of("table.insert({}, -2147483640, 1)").breach == ScriptBreach::instructions);
}

TEST_CASE("a table that loses and gets keys without end is stopped, since it is made anew each time") {
  CHECK(end_of("local t = {} for i = 1, 16384 do t[i + 0.5] = i end\n"
               "for i = 1, 1e9 do t[i + 0.5] = nil t[i + 16384.5] = 1 end",
               {.tick_instructions = 1'000'000'000'000})
            .breach == ScriptBreach::memory);
}

TEST_CASE("what no instruction counts is stopped by the wall clock, whatever the script catches") {
  const std::string texts = "local a, b = ('x'):rep(65000) .. 1, ('x'):rep(65000) .. 2\n";
  for (const std::string& code : {
           texts + "while true do local c = a < b end",
           texts + "while true do pcall(function() return a < b end) end",
           texts + "while true do coroutine.wrap(function() for i = 1, 100 do local c = a < b end end)() end",
           texts + "while true do table.sort { a, b } end",
           std::string("local a = ('x'):rep(32000) while true do local c = a .. a end"),
           std::string("local a = '0x' .. ('f'):rep(65000) while true do local c = a + 0 end"),
           std::string(
               "local function f(...) return select('#', ...) end local t = {} for i = 1, 7000 do t[i] = i end\n"
               "local function g(...) while true do f(...) end end g(unpack(t))"),
           std::string("while true do (('a'):rep(300)):find('.-.-.-b') end"),
           std::string("while true do end"),
       }) {
    CAPTURE(code);
    const ScriptError error = end_of(code, on_wall_clock);
    CHECK(error.breach == ScriptBreach::wall_time);
    CHECK(error.text().find(": time budget exceeded: more than 2.000 ms of wall-clock time in one tick") !=
          std::string::npos);
    CHECK(std::string(error.traceback.data()).find("\tbehaviors/test.lua:") == 0);
  }
}

TEST_CASE("a file that takes long to compile or to run is refused by the wall clock") {
  const std::string wide = "local a return " + [] {
    std::string text;
    for (int i = 0; i < 150'000; ++i) text += "a and ";
    return text;
  }() + "a";
  for (const std::string& text : {wide, std::string("while true do end")}) {
    std::string refused;
    try {
      const Stage stage(text, on_wall_clock);
    } catch (const InputError& error) {
      refused = error.what();
    }
    CHECK_MESSAGE(refused.find("time budget exceeded: more than 10.000 ms") != std::string::npos, refused);
  }
}

TEST_CASE("a chart whose transitions take long, without a function, is stopped by its budget") {
  Stage stage(
      "local k = require 'kadans' local regions = {}\n"
      "for i = 1, 900 do regions[i] = k.region('r' .. i) { initial = 'a', k.state 'a' { { after = 0, to = 'b' } },\n"
      "k.state 'b' { { after = 0, to = 'a' } } } end\n"
      "return k.behavior 'test' { initial = 'p', k.parallel 'p' (regions) }");
  stage.play(3);
  CHECK(stage.behavior->error().text().find("behaviors/test.lua:1: instruction budget exceeded") == 0);
}

TEST_CASE("of a chart with thousands of mistakes the first ones are told") {
  try {
    const Stage stage(
        "local k = require 'kadans' local body = { initial = 's1' }\n"
        "for i = 1, 1900 do body[i] = k.state('s' .. i) { { after = 1, to = 't' .. i } } end\n"
        "return k.behavior 'test' (body)");
    FAIL("it was loaded");
  } catch (const InputError& error) {
    CHECK(error.problems().size() == 20);
  }
}

TEST_CASE("leaving states whose exits raise takes no longer than a tick, all together") {
  Stage stage(
      "local k = require 'kadans' local digits = '0x' .. ('f'):rep(65000) local left = 0\n"
      "local function leave() left = left + 1 for i = 1, 5 do local x = digits + 0 end print(left) error('x') end\n"
      "local state = k.state 'a' { endless = true, exit = leave }\n"
      "for i = 1, 100 do state = k.state 'a' { exit = leave, state } end\n"
      "return k.behavior 'test' { state }",
      on_wall_clock);
  stage.tick();
  stage.behavior->stop(stage.snapshot, stage.sender);
  CHECK(stage.behavior->failed());
  CHECK(stage.log.messages.size() < 50);  // each takes half a millisecond
}

TEST_CASE("a script that goes on when the program was told to end is stopped, on virtual time too") {
  const Interruption interruption;
  for (const char* code : {"while true do pcall(function() while true do end end) end",
                           "while true do (('a'):rep(300)):find('.-.-.-b') end"}) {
    const ScriptError error = end_of(code, {.tick_instructions = 1'000'000'000'000});
    CHECK(error.breach == ScriptBreach::interrupted);
    CHECK(error.text().find("behaviors/test.lua:3: interrupted") == 0);
  }
  CHECK(output_of("print('short')") == "short\n");  // what ends by itself does
}

TEST_CASE("the slots of a table are known, also those that are empty") {
  LuaState lua({.root = {}, .folder = {}, .name = "slots", .seed = 1, .limits = {}, .voice = nullptr});
  CHECK(lua.core().slots.known());
}

#include "behavior_test.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <optional>

#include "script/behavior/behavior.h"
#include "script/bindings/bindings.h"
#include "script/bindings/snapshot_tables.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"
#include "test_prelude.h"

namespace kadans {
namespace {

constexpr std::uint64_t load_instructions_max = 200'000'000;  // of a file
constexpr std::uint64_t test_instructions_max = 100'000'000;  // of each of its tests
constexpr double advance_instructions = 1000;                 // what a call of it is charged ...
constexpr double second_instructions = 20'000;                // ... and each virtual second: 5000 s in one test
constexpr std::size_t memory_max_bytes = std::size_t{64} << 20;
constexpr std::size_t stages_max = 8;  // of one test
constexpr std::size_t tests_max = 100'000;

struct Played {
  std::unique_ptr<TestStage> stage;
  SnapshotTables tables;
  int snapshot = LUA_NOREF;
};

struct Testing {
  LuaState& lua;
  TestStages& stages;
  std::filesystem::path root, file;
  std::vector<Played> played;
  struct Test {
    std::string name;
    int function = LUA_NOREF;
  };
  std::vector<Test> tests;
  std::array<char, 1024> message{};  // of what went wrong where nothing may raise
  std::string text;                  // given to Lua; a member, since Lua may raise
  std::vector<std::string> texts;    // likewise
  PlayedEvent event;                 // likewise, the event that is sent
};

Testing& testing_of(lua_State* state) { return *static_cast<Testing*>(lua_touserdata(state, lua_upvalueindex(1))); }

int raise(lua_State* state, const Testing& testing) {
  luaL_where(state, 2);
  lua_pushstring(state, testing.message.data());
  lua_concat(state, 2);
  return lua_error(state);
}

// The stage whose number is the first argument.
Played& played_in(lua_State* state) {
  Testing& testing = testing_of(state);
  const auto number = static_cast<std::size_t>(lua_tointeger(state, 1));
  if (number >= testing.played.size()) luaL_error(state, "this behavior was played in another test");
  return testing.played[number];
}

// Does what may throw, outside of Lua. False: the message says why.
template <typename Work>
bool attempt(Testing& testing, Work work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    std::snprintf(testing.message.data(), testing.message.size(), "%s", error.what());
    return false;
  }
}

void make_stage(Testing& testing, const char* file, const TestStages::Options& options) {
  const std::filesystem::path beside = testing.file.parent_path() / file;
  const auto path = std::filesystem::exists(beside) ? beside : testing.root / file;
  testing.played.push_back({testing.stages.make(path, options), {}, LUA_NOREF});
}

int push_text(lua_State* state, const std::string& text) { return lua_pushlstring(state, text.data(), text.size()), 1; }

// True, or why not.
int push_answer(lua_State* state, const std::string& why) {
  return why.empty() ? (lua_pushboolean(state, 1), 1) : push_text(state, why);
}

// play(file, robot, plant, scenario) -> number.
int play(lua_State* state) {
  Testing& testing = testing_of(state);
  const char* file = luaL_checkstring(state, 1);
  if (testing.played.size() >= stages_max) return luaL_error(state, "a test plays 8 behaviors at most");
  const char* const with[] = {luaL_checkstring(state, 2), luaL_checkstring(state, 3), luaL_checkstring(state, 4)};
  if (!attempt(testing, [&] { make_stage(testing, file, {with[0], with[1], with[2]}); })) return raise(state, testing);
  Played& played = testing.played.back();
  played.snapshot = played.tables.open(state, played.stage->catalog());
  lua_pushinteger(state, static_cast<lua_Integer>(testing.played.size() - 1));
  return 1;
}

// advance(number, seconds).
int advance(lua_State* state) {
  TestStage& stage = *played_in(state).stage;
  const double seconds = lua_tonumber(state, 2);
  core_of(state).budget.charge(state, advance_instructions + second_instructions * seconds);
  if (!attempt(testing_of(state), [&] { stage.advance(seconds); })) return raise(state, testing_of(state));
  return 0;
}

bool read_text(Testing& testing, TestStage& stage, const char* key) noexcept {
  const auto is = [key](const char* name) { return std::strcmp(key, name) == 0; };
  const Behavior& behavior = stage.behavior();
  testing.text.clear();
  if (is("state")) return testing.text = behavior.state(), true;
  if (is("outcome")) return testing.text = behavior.outcome(), true;
  if (is("error")) return testing.text = behavior.failed() ? behavior.error().text() : "", true;
  if (is("control_sets")) return testing.text = stage.control_sets(), true;
  if (is("log")) return testing.text = stage.said(), true;
  if (is("states")) return testing.text = stage.went(), true;
  return false;
}

// Whether the state with this path is active, innermost or not; nullopt: there is no such state.
std::optional<bool> look_for(Testing& testing, const Behavior& behavior, const char* path) {
  const std::vector<Chart::State>& states = behavior.chart().states;
  const auto found = std::ranges::find(states, path, &Chart::State::path);
  if (*path != '\0' && found != states.end()) return behavior.active(static_cast<StateIndex>(found - states.begin()));
  std::vector<std::string> paths;
  for (const Chart::State& state : states) paths.push_back(state.path);
  testing.text = "the behavior has no state '" + std::string(path) + "'" + hint_text(path, paths);
  return std::nullopt;
}

// is_in(number, path) -> whether this state is active; nil, why: there is none.
int is_in(lua_State* state) {
  TestStage& stage = *played_in(state).stage;
  Testing& testing = testing_of(state);
  const std::optional<bool> in = look_for(testing, stage.behavior(), luaL_checkstring(state, 2));
  if (in) return lua_pushboolean(state, *in ? 1 : 0), 1;
  lua_pushnil(state);
  return 1 + push_text(state, testing.text);
}

// [-0 +1] What the text gives.
int push_value(lua_State* state, Testing& testing, const std::string& text) {
  testing.text = "return " + text;
  if (luaL_loadbuffer(state, testing.text.data(), testing.text.size(), "=result") != 0) return lua_error(state);
  lua_call(state, 0, 1);
  return 1;
}

// read(number, key): what the behavior is in, or a field of the snapshot.
int read(lua_State* state) {
  Played& played = played_in(state);
  const char* key = luaL_checkstring(state, 2);
  Testing& testing = testing_of(state);
  TestStage& stage = *played.stage;
  if (read_text(testing, stage, key)) return push_text(state, testing.text);
  if (std::strcmp(key, "active") == 0) return push_texts(state, testing.texts = stage.behavior().active()), 1;
  if (std::strcmp(key, "result") == 0) return push_value(state, testing, stage.behavior().result());
  if (std::strcmp(key, "orders") == 0) return push_value(state, testing, stage.orders());
  if (std::strcmp(key, "messages") == 0) return push_value(state, testing, stage.messages());
  played.tables.refill(stage.snapshot(), stage.snapshot().time_ns);
  lua_rawgeti(state, LUA_REGISTRYINDEX, played.snapshot);
  lua_getfield(state, -1, key);
  return 1;
}

// emit(number, "event", name, data) -> true, or why not. What raises comes before the event is made.
int emit(lua_State* state, Testing& testing, TestStage& stage) {
  luaL_checktype(state, 4, LUA_TTABLE);
  testing.event = {.name = lua_tostring(state, 3), .who = "test"};
  for (lua_pushnil(state); lua_next(state, 4) != 0; lua_pop(state, 1)) {
    const int type = lua_type(state, -1);
    const bool plain = type == LUA_TNUMBER || type == LUA_TBOOLEAN || type == LUA_TSTRING;
    if (!plain || lua_type(state, -2) != LUA_TSTRING)
      return luaL_error(state, "emit: data is numbers, true, false and texts, by name");
    PlayArgument& field = testing.event.data.emplace_back();
    field.name = lua_tostring(state, -2);
    if (type == LUA_TNUMBER) field.value = lua_tonumber(state, -1);
    if (type == LUA_TBOOLEAN) field.value = lua_toboolean(state, -1) != 0;
    if (type == LUA_TSTRING) field.value = lua_tostring(state, -1);
  }
  return push_answer(state, testing.text = stage.emit(testing.event));
}

// change(number, what, name, value) -> whether it was known; of "event", "ends" and "plays": true, or why not.
int change(lua_State* state) {
  TestStage& stage = *played_in(state).stage;
  Testing& testing = testing_of(state);
  const char* what = luaL_checkstring(state, 2);
  const char* name = luaL_checkstring(state, 3);
  if (std::strcmp(what, "event") == 0) return emit(state, testing, stage);
  if (std::strcmp(what, "ends") == 0) return push_answer(state, testing.text = stage.end_play(name));
  if (std::strcmp(what, "plays") == 0)
    return push_answer(state, testing.text = stage.set_playing(name, luaL_checkstring(state, 4)));
  const double value = luaL_checknumber(state, 4);
  const bool known =
      std::strcmp(what, "parameter") == 0 ? stage.behavior().set_parameter(name, value) : stage.set_sensor(name, value);
  return lua_pushboolean(state, known ? 1 : 0), 1;
}

// add_test(name, function).
int add_test(lua_State* state) {
  Testing& testing = testing_of(state);
  const char* name = luaL_checkstring(state, 1);
  if (testing.tests.size() >= tests_max)
    return luaL_error(state, "a file has %d tests at most", static_cast<int>(tests_max));
  lua_settop(state, 2);
  const int function = luaL_ref(state, LUA_REGISTRYINDEX);
  testing.tests.push_back({name, function});
  return 0;
}

// What the last one played is gone.
void run_test(lua_State* state, int function) {
  lua_gc(state, LUA_GCCOLLECT, 0);
  lua_gc(state, LUA_GCSTOP, 0);
  core_of(state).heap.forgive();
  lua_rawgeti(state, LUA_REGISTRYINDEX, function);
  lua_call(state, 0, 0);
}

// What went wrong in it, "" when nothing did.
std::string problem_of(Testing& testing, const Testing::Test& test) {
  testing.played.clear();
  const auto run = [&](lua_State* state) { run_test(state, test.function); };
  if (testing.lua.call(run, test_instructions_max, 0)) return "";
  const ScriptError& error = testing.lua.error();
  if (error.breach != ScriptBreach::instructions) return error.text();
  ScriptError stopped = error;
  stopped.message = {"stopped, for it did not come to an end: a loop without one?"};
  return stopped.text();
}

// [-1 +0] Into the names that scripts see.
void set_global(lua_State* state, const char* name) {
  push_environment(state);
  push_content(state, -1);
  lua_pushvalue(state, -3);
  lua_setfield(state, -2, name);
  lua_pop(state, 3);
}

void set_in_module(lua_State* state, const char* name) {
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, -1, "kadans");
  push_content(state, -1);
  lua_pushvalue(state, -4);
  lua_setfield(state, -2, name);
  lua_pop(state, 4);
}

void run_file(lua_State* state, Testing& testing) {
  if (luaL_loadbuffer(state, test_prelude, sizeof test_prelude - 1, "=kadans test") != 0) lua_error(state);
  push_environment(state);
  lua_setfenv(state, -2);
  for (const lua_CFunction function : {play, advance, read, change, add_test, is_in}) {
    lua_pushlightuserdata(state, &testing);
    lua_pushcclosure(state, function, 1);
  }
  lua_call(state, 6, 5);
  open_test_names(state);
  if (!testing.lua.load_file(state, testing.file)) lua_error(state);
  lua_call(state, 0, 0);
}

}  // namespace

void open_test_names(lua_State* state) {
  set_in_module(state, "play");
  for (const char* name : {"expect", "before_each", "it", "describe"}) set_global(state, name);
}

std::vector<TestOutcome> run_behavior_tests(const std::filesystem::path& root, const std::filesystem::path& file,
                                            TestStages& stages, const std::string& only) {
  const ScriptLimits limits{.memory_bytes = memory_max_bytes};
  LuaState lua({.root = root, .folder = file.parent_path(), .name = file.stem().string(), .limits = limits});
  Testing testing{lua, stages, root, file, {}, {}, {}, {}, {}};
  testing.played.reserve(stages_max);
  lua.call_or_throw([&](lua_State* state) { run_file(state, testing); }, load_instructions_max, 0);
  std::vector<TestOutcome> outcomes;
  for (const Testing::Test& test : testing.tests) {
    if (test.name.find(only) == std::string::npos) continue;
    const auto began = std::chrono::steady_clock::now();
    std::string problem = problem_of(testing, test);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    outcomes.push_back({.name = test.name, .problem = std::move(problem), .wall_s = took.count()});
  }
  return outcomes;
}

}  // namespace kadans

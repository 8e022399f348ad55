#include <cstring>

#include <lua.hpp>

#include "charge_cases.h"
#include "kadans/signal/input_error.h"
#include "script/behavior/behavior_parts.h"
#include "script/fixture.h"
#include "script/sandbox/sandbox.h"

// A function of its own with a name that callgrind finds.
extern "C" [[gnu::noinline]] int kadans_charged_call(lua_State* state, int arguments) {
  return lua_pcall(state, arguments, 0, 0);
}

namespace kadans::script_test {
namespace {

constexpr std::uint64_t unlimited = 1'000'000'000'000'000;
constexpr const char* behavior_text =
    "local k = require 'kadans'\n"
    "local P = k.params { depth = { 0.1, min = 0, max = 1 } }\n"
    "return k.behavior 'test' { controls = 'posture', k.state 'a' { endless = true } }\n";
// What the code of a case sees.
constexpr const char* case_head = "local k, m, s, P, motion, node = ...\n";

struct Run {
  Behavior::Parts& parts;
  const char* code;
  double charged = 0, values = 0;
};

// [-0 +6]
void push_names(lua_State* state, Behavior::Parts& parts) {
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, -1, "kadans");
  lua_remove(state, -2);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.machines[0].handle);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.snapshot);
  lua_getfield(state, LUA_REGISTRYINDEX, "test.parameters");
  push_motion(state, 1)->setpoints()[0] = 0;
  lua_getfield(state, LUA_REGISTRYINDEX, "test.node");
}

int run_case(lua_State* state) {
  Run& run = *static_cast<Run*>(lua_touserdata(state, 1));
  lua_pushstring(state, case_head);
  lua_pushstring(state, run.code);
  lua_concat(state, 2);
  if (luaL_loadstring(state, lua_tostring(state, -1)) != 0) return lua_error(state);
  push_environment(state);
  lua_setfenv(state, -2);
  const int before = lua_gettop(state) - 1;
  push_names(state, run.parts);
  lua_call(state, 6, LUA_MULTRET);
  Budget& budget = core_of(state).budget;
  const std::uint64_t spent = budget.spent();
  run.values = lua_gettop(state) - before - 1;
  (void)kadans_charged_call(state, static_cast<int>(run.values));
  run.charged = static_cast<double>(budget.spent() - spent);
  return 0;
}

// [-0 +0] Adds the C functions of the table at the top, or of what is behind it, with `prefix` before their names.
void add_functions(lua_State* state, const std::string& prefix, std::set<std::string>& names, int depth = 0) {
  luaL_checkstack(state, 8, "names");
  if (depth > 2 || !lua_istable(state, -1)) return;
  const int top = lua_gettop(state);
  if (!push_content(state, top)) lua_pushvalue(state, top);
  for (lua_pushnil(state); lua_next(state, top + 1) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const std::string name = lua_tostring(state, -2);
    if (lua_iscfunction(state, -1) != 0) names.insert(prefix + name);
    if (lua_istable(state, -1) && name != "_G") add_functions(state, prefix + name + ".", names, depth + 1);
  }
  lua_settop(state, top);
}

// [-1 +0] The metamethods of the value at the top, and what its __index holds.
void add_methods(lua_State* state, const std::string& prefix, std::set<std::string>& names) {
  if (lua_getmetatable(state, -1) != 0) {
    add_functions(state, prefix, names);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

int list_functions(lua_State* state) {
  auto& [parts, names] = *static_cast<std::pair<Behavior::Parts&, std::set<std::string>>*>(lua_touserdata(state, 1));
  lua_settop(state, 0);
  push_environment(state);
  add_functions(state, "", names);
  lua_settop(state, 0);
  push_names(state, parts);
  add_methods(state, "node.", names);
  add_methods(state, "motion.", names);
  add_methods(state, "P.", names);
  add_methods(state, "s.", names);
  add_methods(state, "m.", names);
  add_functions(state, "k.", names);
  push_object(state, 0);
  add_methods(state, "object.", names);
  return 0;
}

}  // namespace

struct ChargedScript::Parts {
  Engine engine;
  Log log;
  Scripts scripts;
  Behavior::Parts behavior{{.root = scripts.root,
                            .file = scripts.write("behaviors/test.lua", behavior_text),
                            .limits = {.memory_bytes = std::size_t{64} << 20}},
                           engine.robot.catalog,
                           log};

  void begin() {
    behavior.bindings.begin(engine.sender, engine.snapshot, engine.snapshot.time_ns);
    behavior.bindings.armed_count = 0;
    behavior.snapshot_tables.refill(engine.snapshot, 0);
  }
};

ChargedScript::ChargedScript() : parts_(std::make_unique<Parts>()) {
  SetpointTable& setpoints = parts_->engine.robot.catalog.setpoints;
  for (SetpointId id = 0; id < setpoints.size(); ++id) setpoints.set_follows(id);
  load_behavior(parts_->behavior);
  parts_->begin();
  const auto keep = [](lua_State* state) {
    static_cast<Behavior::Parts*>(lua_touserdata(state, 1))->runner->tick(state, 0);  // its state is active
    if (luaL_loadstring(state, "local k = require 'kadans' return k.params { depth = 0.1 }, k.call 'x'") != 0)
      return lua_error(state);
    push_environment(state);
    lua_setfenv(state, -2);
    lua_call(state, 0, 2);
    lua_setfield(state, LUA_REGISTRYINDEX, "test.node");
    lua_setfield(state, LUA_REGISTRYINDEX, "test.parameters");
    return 0;
  };
  if (!parts_->behavior.lua->call(keep, &parts_->behavior, unlimited, 0))
    throw InputError({.message = parts_->behavior.lua->error().text()});
}

ChargedScript::~ChargedScript() = default;

ChargedScript::Charge ChargedScript::run(const ChargeCase& of) {
  parts_->begin();
  Run run{parts_->behavior, of.code};
  LuaState& lua = *parts_->behavior.lua;
  const bool ended = lua.call(run_case, &run, unlimited, 0);
  Charge charge{.instructions = run.charged, .values = run.values};
  if (!ended) charge.error = lua.error().text();
  lua_gc(lua.get(), LUA_GCCOLLECT, 0);
  lua_gc(lua.get(), LUA_GCSTOP, 0);
  return charge;
}

std::set<std::string> ChargedScript::reachable() {
  std::pair<Behavior::Parts&, std::set<std::string>> listing{parts_->behavior, {}};
  if (!parts_->behavior.lua->call(list_functions, &listing, unlimited, 0))
    throw InputError({.message = parts_->behavior.lua->error().text()});
  return listing.second;
}

}  // namespace kadans::script_test

#include "known_names.h"

#include <string_view>

#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr int shape_depth_max = 6;

// [-0 +0] The table or read-only table at `index`. Nothing here raises but for want of memory.
void read_shape(lua_State* state, int index, KnownNames::Shape& shape, int depth) {
  luaL_checkstack(state, 8, "shape");
  if (depth > shape_depth_max || !lua_istable(state, index)) return;
  const int top = lua_gettop(state);
  if (!push_content(state, index)) lua_pushvalue(state, index);
  const int content = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, content) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const char* name = lua_tostring(state, -2);
    KnownNames::Shape& field = shape.fields[name];
    if (name[0] == '_') continue;  // _G
    read_shape(state, lua_gettop(state), field, depth + 1);
  }
  lua_settop(state, top);
}

void read_keys(lua_State* state, int reference, std::vector<std::string>& names) {
  if (reference == Chart::no_function) return;
  lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
  KnownNames::Shape shape;
  read_shape(state, lua_gettop(state), shape, shape_depth_max);
  lua_pop(state, 1);
  for (const auto& [name, ignored] : shape.fields) names.push_back(name);
}

void read_methods(lua_State* state, std::vector<std::string>& names) {
  push_object(state, 0);
  lua_getmetatable(state, -1);
  lua_getfield(state, -1, "__index");
  KnownNames::Shape shape;
  read_shape(state, lua_gettop(state), shape, shape_depth_max);
  names = shape.names();
  lua_pop(state, 3);
}

// The fields of a module of the author's own. Its tables are not looked into: they are often data that grows.
void read_module(lua_State* state, int index, KnownNames::Shape& module) {
  module.open = !lua_istable(state, index);
  if (module.open) return;
  if (lua_getmetatable(state, index) != 0) {
    module.open = true;
    return lua_pop(state, 1);
  }
  read_shape(state, index, module, shape_depth_max);
}

void read_modules(lua_State* state, KnownNames& known) {
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  const int modules = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, modules) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING || std::string_view(lua_tostring(state, -2)) == "kadans") continue;
    read_module(state, lua_gettop(state), known.modules[lua_tostring(state, -2)]);
  }
  lua_pop(state, 1);
}

void read_place(lua_State* state, int reference, const char* key, std::size_t of, KnownNames& known) {
  if (reference == Chart::no_function) return;
  lua_Debug function;
  lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
  if (lua_getinfo(state, ">S", &function) == 0 || function.source[0] != '@') return;
  auto& [keys, states] = known.functions[function.source + 1][function.linedefined];
  keys.insert(key);
  states.insert(static_cast<StateIndex>(of));
}

void read_functions(lua_State* state, const Chart& chart, KnownNames& known) {
  for (std::size_t i = 0; i < chart.states.size(); ++i) {
    const Chart::State& one = chart.states[i];
    read_place(state, one.enter, "enter", i, known);
    read_place(state, one.exit, "exit", i, known);
    read_place(state, one.during, "during", i, known);
    read_place(state, one.run, "run", i, known);
    read_place(state, one.result, "result", i, known);
  }
  for (const Chart::Machine& machine : chart.machines) {
    for (const Chart::Given& given : machine.calls_with)
      read_place(state, given.function, "action", chart.states[machine.root].parent, known);
  }
  for (const Chart::Transition& transition : chart.transitions) {
    read_place(state, transition.when, "when", transition.source, known);
    read_place(state, transition.action, "action", transition.source, known);
  }
}

void read(lua_State* state, const Behavior::Parts& parts, KnownNames& known) {
  for (std::size_t i = 0; i < parts.chart.machines.size(); ++i) {
    const std::string& chunk = parts.chart.states[parts.chart.machines[i].root].chunk;
    for (KnownNames::Shape* machine : {&known.machine, &known.machines[chunk]}) {
      lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.machines[i].content);
      read_shape(state, lua_gettop(state), *machine, 0);
      lua_pop(state, 1);
      machine->fields["vars"].open = true;
      KnownNames::Shape& args = machine->fields["args"];
      std::vector<std::string> declared;
      read_keys(state, parts.chart.machines[i].arguments, declared);
      for (const std::string& name : declared) args.fields[name].open = true;
      args.open = args.fields.empty();
    }
  }
  const bool played = !parts.chart.machines.empty();
  known.machine.open = known.snapshot.open = !played;
  if (played) {
    lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.snapshot);
    read_shape(state, lua_gettop(state), known.snapshot, 0);
    KnownNames::Shape& event = known.snapshot.fields["event"];
    event.fields["name"] = {};
    event.fields["data"].open = true;
    // A scenario may give the robot of decisions another world than its configuration does.
    if (KnownNames::Shape& seen = known.snapshot.fields["seen"]; parts.chart.decides && parts.catalog.seen.empty()) {
      seen.fields.clear();
      seen.open = true;
    }
    read_methods(state, known.object_methods);
  }
  read_modules(state, known);
  read_functions(state, parts.chart, known);
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, -1, "kadans");
  read_shape(state, lua_gettop(state), known.module, 0);
  push_environment(state);
  read_shape(state, lua_gettop(state), known.globals, 0);
  for (const Chart::Machine& machine : parts.chart.machines) {
    const std::string& chunk = parts.chart.states[machine.root].chunk;
    read_keys(state, machine.vars, known.vars[chunk]);
    read_keys(state, machine.arguments, known.parameters[chunk]);
  }
}

}  // namespace

std::vector<std::string> KnownNames::Shape::names() const {
  std::vector<std::string> all;
  for (const auto& [name, ignored] : fields) all.push_back(name);
  return all;
}

KnownNames read_known_names(Behavior::Parts& parts) {
  KnownNames known;
  parts.lua->call_or_throw([&](lua_State* state) { read(state, parts, known); },
                           parts.settings.limits.load_instructions, 0);
  for (const ScriptParameter& parameter : parts.lua->core().parameters) {
    known.parameters[parameter.chunk].push_back(parameter.name);
  }
  return known;
}

}  // namespace kadans

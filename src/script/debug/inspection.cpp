#include "inspection.h"

#include <algorithm>
#include <cstdio>

#include <lua.hpp>

#include "script/behavior/behavior_parts.h"
#include "script/chart/chart_calls.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr std::uint64_t instructions_max = 50'000'000;  // of an expression; whoever asks also bounds its time
constexpr std::size_t shown_bytes_max = 4096, shown_inside = 4, fields_max = 10'000;
constexpr int frames_max = 200;

bool is_script(const lua_Debug& activation) { return activation.source[0] == '@'; }

std::string cut(std::string text) {
  if (text.size() > shown_bytes_max) text = text.substr(0, shown_bytes_max) + "...";
  return text;
}

}  // namespace

ScriptMoment script_moment(lua_State* state, StateIndex asked) noexcept {
  const LuaCore& core = core_of(state);
  ScriptMoment moment{.owner = core.owner};
  lua_Debug activation;
  for (int level = 0; lua_getstack(state, level, &activation) != 0; ++level) {
    if (lua_getinfo(state, "S", &activation) != 0 && is_script(activation)) ++moment.depth;
  }
  const auto* bindings = static_cast<const Bindings*>(core.bindings);
  if (core.loading || bindings == nullptr || bindings->runner == nullptr) return moment;
  moment.in_run = core.running != nullptr;
  moment.state = bindings->runner->acting_index();
  moment.run_under_way = asked < bindings->runner->chart().size() && bindings->runner->run_under_way(asked);
  return moment;
}

bool plays_in(Behavior& behavior, lua_State* state) noexcept {
  return core_of(state).owner == behavior.parts().lua.get();
}

// Lua raises by leaving the function: what a work holds then is lost, which a copy of the process can bear.
template <typename Work>
bool Inspection::guarded(Work work) {
  const lua_CFunction call = [](lua_State* state) {
    (*static_cast<Work*>(lua_touserdata(state, 1)))();
    return 0;
  };
  LuaCore& core = behavior_.parts().lua->core();
  core.depth = core.coroutines = 0;
  core.budget.begin(lua_, instructions_max, 0);
  return lua_cpcall(lua_, call, &work) == 0;
}

Inspection::Inspection(Behavior& behavior, lua_State* running) : behavior_(behavior), lua_(nullptr) {
  LuaCore& core = behavior.parts().lua->core();
  lua_ = lua_newthread(core.main);
  (void)luaL_ref(core.main, LUA_REGISTRYINDEX);
  const ChartRunner& runner = *behavior.parts().runner;
  if (running != nullptr) {
    lua_State* const coroutine = core.running;
    add_frames(running, running == core.main || running == coroutine);
    if (coroutine != nullptr && coroutine != running) add_frames(coroutine, true);
    add_states(runner.acting_index());
  } else {
    add_states(runner.innermost());
  }
}

void Inspection::add_frames(lua_State* thread, bool outermost) {
  lua_Debug activation;
  const std::size_t first = spots_.size();
  for (int level = 0; level < frames_max && lua_getstack(thread, level, &activation) != 0; ++level) {
    if (lua_getinfo(thread, "Sl", &activation) == 0 || !is_script(activation)) continue;
    frames_.push_back({"", activation.source + 1, activation.currentline});
    spots_.push_back({thread, level, behavior_.parts().runner->acting_index()});
  }
  for (std::size_t i = first; i < spots_.size(); ++i)
    frames_[i].name = function_name(thread, spots_[i].level, outermost && i + 1 == spots_.size());
}

std::string Inspection::function_name(lua_State* thread, int level, bool outermost) const {
  lua_Debug activation;
  if (lua_getstack(thread, level, &activation) == 0 || lua_getinfo(thread, "nS", &activation) == 0) return "?";
  const Behavior::Parts& parts = behavior_.parts();
  const ChartRunner& runner = *parts.runner;
  if (outermost) {
    const std::string& path = runner.acting().path;
    const int called = parts.lua->core().called;
    return cause_of(runner.chart(), runner.acting_index(), called) + (path.empty() ? "" : " of " + path);
  }
  if (activation.name != nullptr) return activation.name;
  return "function in line " + std::to_string(activation.linedefined);
}

void Inspection::add_states(StateIndex from) {
  const Chart& chart = behavior_.chart();
  for (StateIndex at = from; at != no_state; at = chart.states[at].parent) {
    const Chart::State& state = chart.states[at];
    const bool root = at == 0;
    frames_.push_back({root ? "behavior " + chart.name : "state " + state.path, state.chunk, state.line, true});
    spots_.push_back({nullptr, 0, at});
    if (root) break;
  }
}

std::uint32_t Inspection::add(Lister lister) {
  groups_.push_back(std::move(lister));
  return static_cast<std::uint32_t>(groups_.size());
}

// [-0 +1 when true]
bool Inspection::push_function(const Spot& spot) {
  lua_Debug activation;
  if (spot.thread == nullptr || lua_getstack(spot.thread, spot.level, &activation) == 0) return false;
  lua_getinfo(spot.thread, "f", &activation);
  lua_xmove(spot.thread, lua_, 1);
  return true;
}

// [-0 +1 when there is one]
const char* Inspection::push_local(const Spot& spot, int number) {
  lua_Debug activation;
  if (spot.thread == nullptr || lua_getstack(spot.thread, spot.level, &activation) == 0) return nullptr;
  const char* name = lua_getlocal(spot.thread, &activation, number);
  if (name != nullptr) lua_xmove(spot.thread, lua_, 1);
  return name;
}

// [-0 +1 when true] vars or args of the machine that the state is in.
bool Inspection::push_machine_field(StateIndex state, const char* field) {
  const Behavior::Parts& parts = behavior_.parts();
  push_entry(lua_, parts.tables.machines[parts.chart.states[state].machine].content, field);
  if (lua_istable(lua_, -1)) return true;
  lua_pop(lua_, 1);
  return false;
}

std::string Inspection::text_of(int index, bool inside) {
  char text[64];
  switch (lua_type(lua_, index)) {
    case LUA_TNIL:
      return "nil";
    case LUA_TBOOLEAN:
      return lua_toboolean(lua_, index) != 0 ? "true" : "false";
    case LUA_TNUMBER:
      std::snprintf(text, sizeof text, inside ? "%.6g" : "%.14g", lua_tonumber(lua_, index));
      return text;
    case LUA_TSTRING:
      return "\"" + cut(lua_tostring(lua_, index)) + "\"";
    case LUA_TFUNCTION: {
      lua_Debug activation;
      lua_pushvalue(lua_, index);
      lua_getinfo(lua_, ">S", &activation);
      if (!is_script(activation)) return "function";
      return std::string("function ") + (activation.source + 1) + ":" + std::to_string(activation.linedefined);
    }
    default:
      break;
  }
  if (luaL_callmeta(lua_, index, "__tostring") != 0) {
    std::string told = lua_isstring(lua_, -1) != 0 ? cut(lua_tostring(lua_, -1)) : "?";
    lua_pop(lua_, 1);
    return told;
  }
  if (!lua_istable(lua_, index)) return luaL_typename(lua_, index);
  if (inside) return "{ ... }";
  std::string all;
  std::size_t count = 0;
  const int table = push_content(lua_, index) ? lua_gettop(lua_) : index;
  for (lua_pushnil(lua_); lua_next(lua_, table) != 0; lua_pop(lua_, 1)) ++count;
  std::size_t shown = 0;
  if (count <= shown_inside) {
    each_in_order(lua_, table, [&](int key, int value) {
      if (lua_type(lua_, key) == LUA_TSTRING) all += std::string(lua_tostring(lua_, key)) + " = ";
      all += text_of(value, true) + (++shown < count ? ", " : "");
    });
  }
  if (table != index) lua_pop(lua_, 1);
  if (count > shown_inside) return "{ " + std::to_string(count) + " fields }";
  return count == 0 ? "{}" : "{ " + all + " }";
}

// [-1 +0] The value at the top.
ShownValue Inspection::shown(const std::string& name) {
  const int index = lua_gettop(lua_);
  luaL_checkstack(lua_, 16, "a value");
  ShownValue value{.name = name, .text = text_of(index, false), .type = luaL_typename(lua_, index)};
  if (lua_istable(lua_, index)) {
    if (push_content(lua_, index)) lua_replace(lua_, index);
    const int reference = luaL_ref(lua_, LUA_REGISTRYINDEX);
    value.fields = add([this, reference](auto& to) { list_table(reference, to); });
  } else {
    lua_settop(lua_, index - 1);
  }
  return value;
}

void Inspection::list_locals(const Spot& spot, std::vector<ShownValue>& to) {
  for (int number = 1; const char* name = push_local(spot, number); ++number) {
    if (name[0] == '(') {
      lua_pop(lua_, 1);
      continue;
    }
    std::erase_if(to, [&](const ShownValue& outer) { return outer.name == name; });
    to.push_back(shown(name));
  }
}

void Inspection::list_upvalues(const Spot& spot, std::vector<ShownValue>& to) {
  if (!push_function(spot)) return;
  const int function = lua_gettop(lua_);
  for (int number = 1; const char* name = lua_getupvalue(lua_, function, number); ++number) to.push_back(shown(name));
  lua_settop(lua_, function - 1);
}

// Calls visit(parameter, value) for those of the file of the behavior that the state is in.
template <typename Visit>
void Inspection::each_param(const Spot& spot, Visit visit) {
  const Behavior::Parts& parts = behavior_.parts();
  const std::uint16_t machine = parts.chart.states[spot.state].machine;
  const std::string& chunk = parts.chart.states[parts.chart.machines[machine].root].chunk;
  const auto& all = parts.lua->core().parameters;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].chunk == chunk) visit(all[i], parameter_value(parts.lua->core().main, i, machine));
  }
}

void Inspection::list_params(const Spot& spot, std::vector<ShownValue>& to) {
  each_param(spot, [&](const ScriptParameter& parameter, double value) {
    lua_pushnumber(lua_, value);
    to.push_back(shown(parameter.name));
    if (!parameter.unit.empty()) to.back().text += " " + parameter.unit;
  });
}

void Inspection::list_table(int reference, std::vector<ShownValue>& to) {
  lua_rawgeti(lua_, LUA_REGISTRYINDEX, reference);
  const int table = lua_gettop(lua_);
  each_in_order(lua_, table, [&](int key, int value) {
    if (to.size() >= fields_max) return;
    const bool text = lua_type(lua_, key) == LUA_TSTRING;
    const std::string name = text ? lua_tostring(lua_, key) : "[" + text_of(key, true) + "]";
    lua_pushvalue(lua_, value);
    to.push_back(shown(name));
  });
  lua_settop(lua_, table - 1);
}

void Inspection::list_scopes(std::size_t frame, std::vector<ShownValue>& to) {
  const Spot spot = spots_[frame];
  const auto group = [&](const char* name, Lister lister) { to.push_back({name, "", "", add(std::move(lister))}); };
  if (spot.thread != nullptr) {
    group("locals", [this, spot](auto& values) { list_locals(spot, values); });
    group("upvalues", [this, spot](auto& values) { list_upvalues(spot, values); });
  }
  for (const char* field : {"vars", "args"}) {
    if (push_machine_field(spot.state, field)) to.push_back(shown(field));
  }
  group("params", [this, spot](auto& values) { list_params(spot, values); });
  lua_rawgeti(lua_, LUA_REGISTRYINDEX, behavior_.parts().tables.snapshot);
  to.push_back(shown("s"));
}

std::vector<ShownValue> Inspection::scopes(std::size_t frame) {
  std::vector<ShownValue> all;
  if (frame < spots_.size()) (void)guarded([&] { list_scopes(frame, all); });
  return all;
}

std::vector<ShownValue> Inspection::fields(std::uint32_t number) {
  std::vector<ShownValue> all;
  if (number == 0 || number > groups_.size()) return all;
  const Lister list = groups_[number - 1];  // a copy: it adds groups
  (void)guarded([&] { list(all); });
  return all;
}

// [-0 +1] The environment of an expression: the sandbox, and over it the names of the frame.
void Inspection::push_names(const Spot& spot) {
  const Behavior::Parts& parts = behavior_.parts();
  lua_newtable(lua_);
  const int names = lua_gettop(lua_);
  lua_createtable(lua_, 0, 1);
  push_environment(lua_);
  lua_setfield(lua_, -2, "__index");
  lua_setmetatable(lua_, names);
  lua_rawgeti(lua_, LUA_REGISTRYINDEX, parts.tables.machines[parts.chart.states[spot.state].machine].handle);
  lua_setfield(lua_, names, "m");
  lua_rawgeti(lua_, LUA_REGISTRYINDEX, parts.tables.snapshot);
  lua_setfield(lua_, names, "s");
  for (const char* field : {"vars", "args"}) {
    if (push_machine_field(spot.state, field)) lua_setfield(lua_, names, field);
  }
  if (push_function(spot)) {
    for (int i = 1; const char* name = lua_getupvalue(lua_, names + 1, i); ++i) lua_setfield(lua_, names, name);
    lua_settop(lua_, names);
  }
  for (int i = 1; const char* name = push_local(spot, i); ++i) lua_setfield(lua_, names, name);
  lua_newtable(lua_);
  each_param(spot,
             [&](const ScriptParameter& parameter, double value) { set_field(lua_, parameter.name.c_str(), value); });
  lua_setfield(lua_, names, "params");
}

bool Inspection::run(const Spot& spot, const std::string& lua, ShownValue& value) {
  const std::string returned = "return " + lua;
  int status = luaL_loadbuffer(lua_, returned.data(), returned.size(), "=expression");
  if (status == LUA_ERRSYNTAX) {
    lua_settop(lua_, 0);
    status = luaL_loadbuffer(lua_, lua.data(), lua.size(), "=expression");
  }
  if (status == 0) {
    push_names(spot);
    lua_setfenv(lua_, -2);
    status = lua_pcall(lua_, 0, 1, 0);
  }
  if (status == 0) return value = shown(lua), true;
  value.text = lua_isstring(lua_, -1) != 0 ? lua_tostring(lua_, -1) : "it took too much";
  return false;
}

bool Inspection::evaluate(std::size_t frame, const std::string& lua, ShownValue& value) {
  bool well = false;
  if (spots_.empty()) return value.text = "no script stands here", false;
  const Spot spot = spots_[frame < spots_.size() ? frame : 0];
  if (lua.starts_with('\x1b')) return value.text = "is bytecode", false;
  if (!guarded([&] { well = run(spot, lua, value); })) value.text = "it took too much memory";
  return well;
}

}  // namespace kadans

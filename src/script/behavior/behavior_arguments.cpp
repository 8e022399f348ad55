// What a behavior is played with: the robot's values of its parameters, and arguments, which are values of its `args`,
// as from k.call, or of its parameters.
#include <algorithm>
#include <utility>

#include "behavior_parts.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

struct Giving {
  Behavior::Parts& parts;
  std::vector<std::pair<std::string, int>> declared{};  // name and Lua type of the default
  std::vector<const PlayArgument*> given{};
};

int read_declared(lua_State* state) {
  Giving& giving = *static_cast<Giving*>(lua_touserdata(state, 1));
  const int arguments = giving.parts.chart.machines.front().arguments;
  if (arguments == Chart::no_function) return 0;
  lua_rawgeti(state, LUA_REGISTRYINDEX, arguments);
  for (lua_pushnil(state); lua_next(state, 2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) == LUA_TSTRING) giving.declared.emplace_back(lua_tostring(state, -2), lua_type(state, -1));
  }
  return 0;
}

void push(lua_State* state, const PlayValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return lua_pushnumber(state, *number);
  if (const auto* flag = std::get_if<bool>(&value)) return lua_pushboolean(state, *flag ? 1 : 0);
  const auto& text = *std::get_if<std::string>(&value);
  lua_pushlstring(state, text.data(), text.size());
}

int keep_given(lua_State* state) {
  const Giving& giving = *static_cast<const Giving*>(lua_touserdata(state, 1));
  lua_newtable(state);
  for (const PlayArgument* argument : giving.given) {
    push(state, argument->value);
    lua_setfield(state, 2, argument->name.c_str());
  }
  giving.parts.chart.machines.front().given = luaL_ref(state, LUA_REGISTRYINDEX);
  return 0;
}

const char* kind_name(int type) {
  switch (type) {
    case LUA_TNUMBER:
      return "a number";
    case LUA_TBOOLEAN:
      return "true or false";
    case LUA_TSTRING:
      return "a text";
    default:
      return "a table, which only k.call can give";
  }
}

int type_of(const PlayValue& value) {
  constexpr int lua_types[] = {LUA_TNUMBER, LUA_TBOOLEAN, LUA_TSTRING};
  return lua_types[value.index()];
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

ScriptParameter* find_parameter(Behavior::Parts& parts, const std::string& name) {
  for (ScriptParameter& parameter : parts.lua->core().parameters) {
    if (parameter.name == name) return &parameter;
  }
  return nullptr;
}

std::string who(const std::string& behavior) { return "of behavior '" + behavior + "'"; }

// "", or why it cannot be set so.
std::string set(ScriptParameter& parameter, double value, const std::string& behavior) {
  if (value >= parameter.min && value <= parameter.max) {
    parameter.value = value;
    return "";
  }
  return "parameter '" + parameter.name + "' " + who(behavior) + " = " + number(value) + " is outside its range " +
         number(parameter.min) + ".." + number(parameter.max) + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

// What a robot's file calls it: the chunk, or, when the behavior was reloaded from another file, that of its first one.
const std::string& first_name(const Behavior::Parts& parts, const std::string& chunk) {
  return chunk == parts.lua->sources().front().chunk ? parts.settings.chunk : chunk;
}

// What is wrong with it, or "".
std::string give(Behavior::Parts& parts, const BehaviorValue& given) {
  std::vector<std::string> names;
  for (ScriptParameter& parameter : parts.lua->core().parameters) {
    if (first_name(parts, parameter.chunk) != given.chunk) continue;
    if (parameter.name == given.parameter) {
      const std::string wrong = set(parameter, given.value, given.behavior);
      parameter.initial = parameter.value;
      return wrong;
    }
    names.push_back(parameter.name);
  }
  return "behavior '" + given.behavior + "' has no parameter '" + given.parameter + "'" +
         hint_text(given.parameter, names);
}

// What is wrong with it, or "".
std::string give(Giving& giving, const PlayArgument& argument) {
  const std::string& behavior = giving.parts.chart.name;
  for (const auto& [name, type] : giving.declared) {
    if (name != argument.name) continue;
    if (type != type_of(argument.value)) return "argument '" + name + "' " + who(behavior) + " is " + kind_name(type);
    giving.given.push_back(&argument);
    return "";
  }
  if (ScriptParameter* parameter = find_parameter(giving.parts, argument.name)) {
    const auto* value = std::get_if<double>(&argument.value);
    if (value == nullptr) return "parameter '" + argument.name + "' " + who(behavior) + " is a number";
    return set(*parameter, *value, behavior);
  }
  std::vector<std::string> names;
  for (const auto& declared : giving.declared) names.push_back(declared.first);
  for (const ScriptParameter& known : giving.parts.lua->core().parameters) names.push_back(known.name);
  return "behavior '" + behavior + "' takes no argument '" + argument.name + "'" + hint_text(argument.name, names);
}

}  // namespace

void give_robot_values(Behavior::Parts& parts) {
  if (parts.settings.chunk.empty()) parts.settings.chunk = parts.lua->sources().front().chunk;
  std::vector<InputProblem> problems;
  for (const BehaviorValue& given : parts.catalog.behavior_values) {
    const auto is_its = [&](const LuaState::Source& source) { return first_name(parts, source.chunk) == given.chunk; };
    if (std::ranges::none_of(parts.lua->sources(), is_its)) continue;
    const std::string wrong = give(parts, given);
    if (!wrong.empty()) problems.push_back({given.file, given.line, given.column, wrong});
  }
  if (!problems.empty()) throw InputError(problems);
}

void give_arguments(Behavior::Parts& parts, std::uint64_t instructions) {
  const Behavior::Settings& settings = parts.settings;
  if (settings.arguments.empty()) return;
  Giving giving{parts};
  std::vector<InputProblem> problems;
  bool done = parts.lua->call(read_declared, &giving, instructions, settings.limits.load_wall_ns);
  for (const PlayArgument& argument : settings.arguments) {
    const std::string wrong = give(giving, argument);
    if (!wrong.empty()) problems.push_back({settings.source, argument.place.line, argument.place.column, wrong});
  }
  if (!problems.empty()) throw InputError(problems);
  done = done && parts.lua->call(keep_given, &giving, instructions, settings.limits.load_wall_ns);
  if (!done) throw InputError({.file = settings.source, .message = parts.lua->error().text()});
}

}  // namespace kadans

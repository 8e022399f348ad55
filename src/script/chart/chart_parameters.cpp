// k.params { name = { default, min =, max =, unit =, doc = } }.
//
// While a file loads, P.name is a handle, so that `after = P.name` follows the parameter; once the behavior runs it is
// the number itself.
#include <cmath>
#include <cstring>
#include <limits>

#include "chart_calls.h"
#include "chart_reader.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const HandleKey handle_key = 0;
constexpr std::size_t parameters_max = 1000, parameter_text_max = 512;  // they are kept outside the script's memory
constexpr double parameter_instructions = 200;
constexpr const char* spec_keys[] = {"min", "max", "unit", "doc", nullptr};

double number_field(lua_State* state, int table, const char* name, double fallback, const ScriptPlace& place) {
  lua_getfield(state, table, name);
  if (!lua_isnil(state, -1) && lua_type(state, -1) != LUA_TNUMBER) {
    raise_at(state, place, name, "'%s' must be a number, not a %s", name, luaL_typename(state, -1));
  }
  const double value = lua_isnil(state, -1) ? fallback : lua_tonumber(state, -1);
  lua_pop(state, 1);
  return value;
}

const char* text_field(lua_State* state, int table, const char* name, const ScriptPlace& place) {
  lua_getfield(state, table, name);
  if (!lua_isnil(state, -1) && lua_type(state, -1) != LUA_TSTRING) {
    raise_at(state, place, name, "'%s' must be a string, not a %s", name, luaL_typename(state, -1));
  }
  if (lua_objlen(state, -1) > parameter_text_max)
    raise_at(state, place, name, "'%s' is longer than %d characters", name, static_cast<int>(parameter_text_max));
  const char* text = lua_tostring(state, -1);
  lua_pop(state, 1);
  return text != nullptr ? text : "";  // anchored by the table
}

struct Spec {
  const char* name;
  double initial, min, max;
  const char* unit;
  const char* doc;
};

// The specification at the top, of parameter `name`.
Spec read_spec(lua_State* state, const char* name, const ScriptPlace& place) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (lua_type(state, -1) == LUA_TNUMBER) return {name, lua_tonumber(state, -1), -infinity, infinity, "", ""};
  if (!lua_istable(state, -1))
    raise_at(state, place, name, "parameter '%s' must be { default, min =, max =, unit =, doc = }", name);
  const int table = lua_gettop(state);
  check_keys(state, table, place, "a parameter", spec_keys);
  lua_rawgeti(state, table, 1);
  if (lua_type(state, -1) != LUA_TNUMBER)
    raise_at(state, place, name, "parameter '%s' needs a default, a number, first in its table", name);
  const double initial = lua_tonumber(state, -1);
  lua_pop(state, 1);
  return {name,
          initial,
          number_field(state, table, "min", -infinity, place),
          number_field(state, table, "max", infinity, place),
          text_field(state, table, "unit", place),
          text_field(state, table, "doc", place)};
}

void add_parameter(lua_State* state, const Spec& spec, const ScriptPlace& place) {
  if (spec.min > spec.max)
    raise_at(state, place, spec.name, "parameter '%s': min = %f is greater than max = %f", spec.name, spec.min,
             spec.max);
  if (!(spec.initial >= spec.min && spec.initial <= spec.max)) {
    raise_at(state, place, spec.name, "parameter '%s': the default %f is outside %f..%f", spec.name, spec.initial,
             spec.min, spec.max);
  }
  if (core_of(state).parameters.size() >= parameters_max || std::strlen(spec.name) > parameter_text_max)
    raise_at(state, place, nullptr, "more than %d parameters, or a name longer than %d characters",
             static_cast<int>(parameters_max), static_cast<int>(parameter_text_max));
  ScriptParameter& added = core_of(state).parameters.emplace_back();
  added = {place.chunk, spec.name, spec.unit, spec.doc, spec.initial, spec.min, spec.max, spec.initial};
}

int read_parameter(lua_State* state) {  // (proxy, key); upvalue: name -> handle
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(1));
  const std::size_t* number = to_parameter(state, 3);
  if (number == nullptr) return raise_unknown_field(state, "k.params", lua_upvalueindex(1), 2);
  if (!core_of(state).loading) lua_pushnumber(state, value_here(state, *number));
  return 1;
}

int refuse_write(lua_State* state) {
  return luaL_error(state, "a behavior does not set its own parameters: keep what changes in m.vars");
}

int refuse_arithmetic(lua_State* state) {
  return luaL_error(state, "a parameter has its value when the behavior runs: use it inside a function, or as 'after'");
}

// params(table) -> the parameters by name.
int params(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  if (!lua_istable(state, 1)) return raise_at(state, place, nullptr, "k.params needs a table { name = { ... } }");
  lua_settop(state, 1);
  lua_newtable(state);
  each_in_order(state, 1, [&](int key, int) {  // so that parameters are numbered the same in every run
    if (lua_type(state, key) != LUA_TSTRING) raise_at(state, place, nullptr, "k.params: every parameter needs a name");
    core_of(state).budget.charge(state, parameter_instructions);
    add_parameter(state, read_spec(state, lua_tostring(state, key), place), place);
    auto* handle = static_cast<std::size_t*>(lua_newuserdata(state, sizeof(std::size_t)));
    *handle = core_of(state).parameters.size() - 1;
    set_kind(state, handle_key);
    lua_pushvalue(state, key);
    lua_insert(state, -2);
    lua_rawset(state, 2);
  });
  push_reader(state, read_parameter, refuse_write);
  return 1;
}

}  // namespace

const std::size_t* to_parameter(lua_State* state, int index) {
  return static_cast<const std::size_t*>(to_handle(state, index, handle_key));
}

void open_parameters(lua_State* state) {
  lua_newtable(state);
  for (const char* event : {"__add", "__sub", "__mul", "__div", "__mod", "__pow", "__unm", "__lt", "__le", "__concat",
                            "__index", "__call"}) {
    lua_pushcfunction(state, refuse_arithmetic);
    lua_setfield(state, -2, event);
  }
  open_kind(state, handle_key);
  lua_pushcfunction(state, params);
  lua_setfield(state, -2, "params");
}

}  // namespace kadans

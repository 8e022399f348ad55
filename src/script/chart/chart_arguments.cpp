#include "chart_arguments.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "chart_runner.h"
#include "script/bindings/bindings.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const HandleKey arguments_key = 0;
constexpr int declared_max = 100, choices_max = 32;
constexpr std::size_t argument_text_max = 512;
constexpr double argument_instructions = 200;
constexpr const char* declaration_keys[] = {"min", "max", "unit", "doc", "one_of", nullptr};
constexpr const char* by_file = "kadans.arguments";

const char* type_word(int type) noexcept {
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

bool bound(lua_State* state, int declared, const char* key, double& value) {
  lua_getfield(state, declared, key);
  const bool there = lua_type(state, -1) == LUA_TNUMBER;
  if (there) value = lua_tonumber(state, -1);
  lua_pop(state, 1);
  return there;
}

// [-0 +1 when true] Whether the text at `value` is none of those at the top of the stack.
bool push_wrong_choice(lua_State* state, int value, const char* name, const char* of) {
  const int choices = lua_gettop(state);
  const auto count = static_cast<int>(lua_objlen(state, choices));
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, choices, i);
    const bool same = lua_rawequal(state, -1, value) != 0;
    lua_pop(state, 1);
    if (same) return false;
  }
  const Hint hint = make_hint(state, lua_tostring(state, value), [&](auto& names) {
    for (int i = 1; i <= count; ++i) {
      lua_rawgeti(state, choices, i);
      names.emplace_back(lua_tostring(state, -1));
      lua_pop(state, 1);
    }
  });
  lua_pushfstring(state, "argument '%s' of %s cannot be '%s'%s", name, of, lua_tostring(state, value), hint.data());
  return true;
}

void check_bound(lua_State* state, int declared, const char* key, bool number, const char* name,
                 const ScriptPlace& place) {
  lua_getfield(state, declared, key);
  const bool good = lua_isnil(state, -1) || (number && lua_type(state, -1) == LUA_TNUMBER);
  if (!good) raise_at(state, place, name, "argument '%s': '%s' is a number, beside a default that is one", name, key);
  lua_pop(state, 1);
}

void check_text(lua_State* state, int declared, const char* key, const char* name, const ScriptPlace& place) {
  lua_getfield(state, declared, key);
  const bool text = lua_type(state, -1) == LUA_TSTRING && lua_objlen(state, -1) <= argument_text_max;
  if (!text && !lua_isnil(state, -1))
    raise_at(state, place, name, "argument '%s': '%s' is a text of at most %d characters", name, key,
             static_cast<int>(argument_text_max));
  lua_pop(state, 1);
}

void check_choices(lua_State* state, int declared, bool text, const char* name, const ScriptPlace& place) {
  lua_getfield(state, declared, "one_of");
  const int choices = lua_gettop(state);
  const bool list = lua_istable(state, choices);
  const auto count = list ? static_cast<int>(lua_objlen(state, choices)) : 0;
  if (!lua_isnil(state, choices) && (!text || count < 1 || count > choices_max))
    raise_at(state, place, name, "argument '%s': 'one_of' lists 1..%d texts, beside a default that is one", name,
             choices_max);
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, choices, i);
    if (lua_type(state, -1) != LUA_TSTRING || lua_objlen(state, -1) > argument_text_max)
      raise_at(state, place, name, "argument '%s': 'one_of' lists texts, not a %s", name, luaL_typename(state, -1));
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

// [-0 +1] The declaration at `index`, checked; a bare number, text, true or false is its own default.
void push_declaration(lua_State* state, int index, const char* name, const ScriptPlace& place) {
  core_of(state).budget.charge(state, argument_instructions);
  lua_newtable(state);
  const int made = lua_gettop(state);
  const bool table = lua_istable(state, index);
  if (table) {
    check_keys(state, index, place, "an argument", declaration_keys);
    lua_rawgeti(state, index, 1);
  } else {
    lua_pushvalue(state, index);
  }
  const int type = lua_type(state, -1);
  const bool plain =
      type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TBOOLEAN || (table && type == LUA_TTABLE);
  if (!plain || std::strlen(name) > argument_text_max)
    raise_at(
        state, place, name,
        "argument '%s' must be { default, min =, max =, unit =, one_of =, doc = }: the default is a number, a text, "
        "true, false or a table",
        name);
  lua_rawseti(state, made, 1);
  for (const char* const* key = declaration_keys; table && *key != nullptr; ++key) {
    lua_getfield(state, index, *key);
    lua_setfield(state, made, *key);
  }
  for (const char* key : {"min", "max"}) check_bound(state, made, key, type == LUA_TNUMBER, name, place);
  for (const char* key : {"unit", "doc"}) check_text(state, made, key, name, place);
  check_choices(state, made, type == LUA_TSTRING, name, place);
  lua_rawgeti(state, made, 1);
  if (push_refusal(state, made, lua_gettop(state), name, "k.args"))
    raise_at(state, place, name, "the default: %s", lua_tostring(state, -1));
  lua_settop(state, made);
}

// A.name inside a function: the value that the behavior was called with.
int read_argument(lua_State* state) {  // (handle, key)
  if (core_of(state).loading)
    return luaL_error(state, "an argument has its value when the behavior runs: use it inside a function");
  const Bindings* bindings = static_cast<const Bindings*>(core_of(state).bindings);
  if (bindings == nullptr || bindings->runner == nullptr) return luaL_error(state, "no behavior runs here");
  bindings->runner->push_arguments(state);
  lua_pushvalue(state, 2);
  lua_rawget(state, -2);
  if (lua_isnil(state, -1)) return raise_unknown_field(state, "k.args", lua_gettop(state) - 1, 2);
  return 1;
}

std::optional<PlayValue> default_of(lua_State* state, int declared) {
  std::optional<PlayValue> value;
  lua_rawgeti(state, declared, 1);
  if (lua_type(state, -1) == LUA_TNUMBER) value = lua_tonumber(state, -1);
  if (lua_type(state, -1) == LUA_TBOOLEAN) value = lua_toboolean(state, -1) != 0;
  if (lua_type(state, -1) == LUA_TSTRING) value = std::string(lua_tostring(state, -1));
  lua_pop(state, 1);
  return value;
}

int refuse_argument_write(lua_State* state) {
  return luaL_error(state, "a behavior does not set its own arguments: keep what changes in m.vars");
}

// args(table) -> the arguments by name.
int args(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  if (!lua_istable(state, 1)) return raise_at(state, place, nullptr, "k.args needs a table { name = { ... } }");
  lua_settop(state, 1);
  lua_newtable(state);
  push_declarations(state, 1, place);
  lua_getfield(state, LUA_REGISTRYINDEX, by_file);
  lua_pushvalue(state, 3);
  lua_setfield(state, 4, place.chunk);
  lua_settop(state, 3);
  lua_rawseti(state, 2, 1);
  set_kind(state, arguments_key);
  return 1;
}

}  // namespace

void push_declarations(lua_State* state, int index, const ScriptPlace& place) {
  if (is_kind(state, index, arguments_key)) return lua_rawgeti(state, index, 1);
  lua_newtable(state);
  const int all = lua_gettop(state);
  int count = 0;
  charge_table(state, index);
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    if (lua_type(state, all + 1) != LUA_TSTRING) raise_at(state, place, nullptr, "every argument needs a name");
    if (++count > declared_max) raise_at(state, place, nullptr, "more than %d arguments", declared_max);
    push_declaration(state, all + 2, lua_tostring(state, all + 1), place);
    lua_pushvalue(state, all + 1);
    lua_insert(state, -2);
    lua_rawset(state, all);
  }
}

void push_file_declarations(lua_State* state, const char* chunk) {
  lua_getfield(state, LUA_REGISTRYINDEX, by_file);
  lua_getfield(state, -1, chunk);
  lua_remove(state, -2);
}

bool push_refusal(lua_State* state, int declared, int value, const char* name, const char* of) {
  const int type = lua_type(state, value);
  lua_rawgeti(state, declared, 1);
  const int wanted = lua_type(state, -1);
  lua_pop(state, 1);
  if (type != wanted) return lua_pushfstring(state, "argument '%s' of %s is %s", name, of, type_word(wanted)), true;
  if (type == LUA_TNUMBER) {
    double min = -HUGE_VAL, max = HUGE_VAL;
    const double number = lua_tonumber(state, value);
    const bool ranged = bound(state, declared, "min", min) || bound(state, declared, "max", max);
    (void)bound(state, declared, "max", max);
    if (number >= min && number <= max) return false;
    lua_getfield(state, declared, "unit");
    const char* unit = lua_tostring(state, -1);
    if (ranged) {
      lua_pushfstring(state, "argument '%s' of %s = %f is outside its range %f..%f%s%s", name, of, number, min, max,
                      unit != nullptr ? " " : "", unit != nullptr ? unit : "");
    } else {
      lua_pushfstring(state, "argument '%s' of %s is a number, not %f", name, of, number);
    }
    return lua_remove(state, -2), true;
  }
  if (type != LUA_TSTRING) return false;
  lua_getfield(state, declared, "one_of");
  const bool wrong = lua_istable(state, -1) && push_wrong_choice(state, value, name, of);
  lua_remove(state, wrong ? -2 : -1);
  return wrong;
}

bool push_followed_refusal(lua_State* state, int declared, const ScriptParameter& parameter, const char* name,
                           const char* of) {
  for (const double end : {parameter.min, parameter.max}) {
    lua_pushnumber(state, end);
    const int number = lua_gettop(state);
    if (push_refusal(state, declared, number, name, of)) {
      lua_pushfstring(state, "parameter '%s', which '%s' follows, may be %f: %s", parameter.name.c_str(), name, end,
                      lua_tostring(state, -1));
      lua_replace(state, number);
      return lua_settop(state, number), true;
    }
    lua_settop(state, number - 1);
  }
  return false;
}

std::string text_of_field(lua_State* state, int table, const char* key) {
  lua_getfield(state, table, key);
  const std::string text = lua_type(state, -1) == LUA_TSTRING ? lua_tostring(state, -1) : "";
  lua_pop(state, 1);
  return text;
}

std::vector<ScriptArgument> read_declarations(lua_State* state, int index) {
  std::vector<ScriptArgument> all;
  luaL_checkstack(state, 8, "arguments");
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    const int one = lua_gettop(state);
    ScriptArgument& argument = all.emplace_back();
    argument.name = lua_tostring(state, one - 1);
    argument.unit = text_of_field(state, one, "unit");
    argument.doc = text_of_field(state, one, "doc");
    argument.initial = default_of(state, one);
    (void)bound(state, one, "min", argument.min);
    (void)bound(state, one, "max", argument.max);
    lua_getfield(state, one, "one_of");
    const auto count = lua_istable(state, -1) ? static_cast<int>(lua_objlen(state, -1)) : 0;
    for (int i = 1; i <= count; ++i) {
      lua_rawgeti(state, one + 1, i);
      argument.one_of.emplace_back(lua_tostring(state, -1));
      lua_pop(state, 1);
    }
    lua_pop(state, 1);
  }
  std::ranges::sort(all, {}, &ScriptArgument::name);
  return all;
}

void open_arguments(lua_State* state) {
  lua_newtable(state);
  lua_setfield(state, LUA_REGISTRYINDEX, by_file);
  const luaL_Reg functions[] = {{"__index", read_argument}, {"__newindex", refuse_argument_write}};
  open_kind(state, arguments_key, functions);
  lua_pushcfunction(state, args);
  lua_setfield(state, -2, "args");
}

}  // namespace kadans

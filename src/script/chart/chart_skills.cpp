#include "chart_skills.h"

#include <cstring>

#include "chart_arguments.h"
#include "chart_calls.h"
#include "chart_reader.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const HandleKey skill_key = 0;
constexpr double skill_instructions = 300, argument_instructions_each = 50;
constexpr const char* skill_keys[] = {"doc", "args", "make", nullptr};

// The stack of use_skill: what is called with, and what it works with.
enum Place : int { at_body = 1, at_skill, at_declared, at_given, at_node, at_made };

int refuse_change(lua_State* state) {
  return luaL_error(state, "a skill and its arguments do not change: keep what changes in m.vars");
}

void refuse_unknown(lua_State* state, const char* key, const char* name, const ScriptPlace& place) {
  const Hint hint = make_hint(state, key, [&](auto& names) {
    for (lua_pushnil(state); lua_next(state, at_declared) != 0; lua_pop(state, 1))
      names.emplace_back(lua_tostring(state, -2));
  });
  raise_at(state, place, key, "skill '%s' takes no argument '%s'%s", name, key, hint.data());
}

// The defaults, and over them what the body gives by name.
void fill_given(lua_State* state, const char* name, const ScriptPlace& place) {
  for (lua_pushnil(state); lua_next(state, at_declared) != 0; lua_pop(state, 1)) {
    core_of(state).budget.charge(state, argument_instructions_each);
    lua_pushvalue(state, -2);
    lua_rawgeti(state, -2, 1);
    lua_rawset(state, at_given);
  }
  charge_table(state, at_body);
  for (lua_pushnil(state); lua_next(state, at_body) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const char* key = lua_tostring(state, -2);
    const int value = lua_gettop(state);
    lua_getfield(state, at_declared, key);
    if (lua_isnil(state, -1)) refuse_unknown(state, key, name, place);
    const std::size_t* number = to_parameter(state, value);
    const char* of = lua_pushfstring(state, "skill '%s'", name);
    const bool wrong = number != nullptr
                           ? push_followed_refusal(state, value + 1, core_of(state).parameters[*number], key, of)
                           : push_refusal(state, value + 1, value, key, of);
    if (wrong) raise_at(state, place, key, "%s", lua_tostring(state, -1));
    lua_settop(state, value);
    lua_pushvalue(state, value - 1);
    lua_pushvalue(state, value);
    lua_rawset(state, at_given);
  }
}

// a.name; upvalue: the arguments. One that follows a parameter is a handle while the file loads, so that `after =
// a.name` follows it, too, and later the parameter's value.
int read_given_argument(lua_State* state) {  // (proxy, key)
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(1));
  if (lua_isnil(state, 3)) return raise_unknown_field(state, "the skill's arguments", lua_upvalueindex(1), 2);
  const std::size_t* number = to_parameter(state, 3);
  if (!core_of(state).loading && number != nullptr) lua_pushnumber(state, value_here(state, *number));
  return 1;
}

// [-0 +1] What `make` returns.
void push_made(lua_State* state, const char* name, const ScriptPlace& place) {
  lua_getfield(state, at_skill, "make");
  lua_pushvalue(state, at_given);
  push_reader(state, read_given_argument, refuse_change);
  lua_call(state, 1, 1);
  const std::optional<NodeKind> kind = node_kind(state, -1);
  const bool good = kind && kind != NodeKind::behavior && kind != NodeKind::region && kind != NodeKind::final_state &&
                    kind != NodeKind::history;
  if (good) return;
  raise_at(state, place, nullptr, "skill '%s': its make must return a k.state, k.parallel or k.call", name);
}

// skill "name" { argument = value, transitions }; upvalues: the skill, the state's name, chunk, line.
int use_skill(lua_State* state) {
  const ScriptPlace place{lua_tostring(state, lua_upvalueindex(3)),
                          static_cast<int>(lua_tointeger(state, lua_upvalueindex(4)))};
  lua_settop(state, at_body);
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_getfield(state, at_skill, "name");
  const char* name = lua_tostring(state, -1);  // anchored by the skill
  lua_pop(state, 1);
  if (!lua_istable(state, at_body)) return raise_at(state, place, nullptr, "skill '%s' needs a table { ... }", name);
  core_of(state).budget.charge(state, skill_instructions);
  lua_getfield(state, at_skill, "args");
  lua_newtable(state);
  fill_given(state, name, place);
  push_made(state, name, place);
  lua_newtable(state);
  lua_pushvalue(state, at_node);
  lua_rawseti(state, at_made, 1);
  const auto count = static_cast<int>(lua_objlen(state, at_body));
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, at_body, i);
    if (const std::optional<NodeKind> kind = node_kind(state, -1))
      raise_at(state, place, node_name(state, lua_gettop(state)), "a skill takes arguments and transitions, not a %s",
               node_word(*kind));
    lua_rawseti(state, at_made, i + 1);
  }
  push_node_maker(state, NodeKind::state, lua_upvalueindex(2), place);
  lua_pushvalue(state, at_made);
  lua_call(state, 1, 1);
  return 1;
}

int name_state(lua_State* state) {  // (skill, name)
  const ScriptPlace place = calling_place(state);
  lua_settop(state, 2);
  lua_rawgeti(state, 1, 1);
  lua_remove(state, 1);  // name, content
  check_node_name(state, "a skill's state", place);
  lua_pushvalue(state, 2);
  lua_pushvalue(state, 1);
  lua_pushstring(state, place.chunk);
  lua_pushinteger(state, place.line);
  lua_pushcclosure(state, use_skill, 4);
  return 1;
}

// k.skill "name" { doc = , args = , make = }; upvalues: name, chunk, line.
int finish_skill(lua_State* state) {
  const char* name = lua_tostring(state, lua_upvalueindex(1));
  const ScriptPlace place{lua_tostring(state, lua_upvalueindex(2)),
                          static_cast<int>(lua_tointeger(state, lua_upvalueindex(3)))};
  lua_settop(state, 1);
  if (!lua_istable(state, 1)) return raise_at(state, place, nullptr, "k.skill \"%s\" needs a table { ... }", name);
  check_keys(state, 1, place, "k.skill", skill_keys);
  lua_getfield(state, 1, "doc");
  lua_getfield(state, 1, "make");
  if (lua_type(state, 2) != LUA_TSTRING)
    return raise_at(state, place, "doc", "k.skill \"%s\" needs doc = \"what it does\"", name);
  if (!lua_isfunction(state, 3))
    return raise_at(state, place, "make", "k.skill \"%s\" needs make = function(a) return k.state ... end", name);
  lua_createtable(state, 0, 4);
  lua_getfield(state, 1, "args");
  if (lua_isnil(state, 5)) {
    lua_newtable(state);
  } else if (lua_istable(state, 5)) {
    push_declarations(state, 5, place);
  } else {
    return raise_at(state, place, "args", "k.skill: 'args' must be a table, not a %s", luaL_typename(state, 5));
  }
  lua_setfield(state, 4, "args");
  lua_settop(state, 4);
  lua_pushvalue(state, 3);
  lua_setfield(state, 4, "make");
  lua_pushvalue(state, 2);
  lua_setfield(state, 4, "doc");
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_setfield(state, 4, "name");
  lua_createtable(state, 1, 0);
  lua_pushvalue(state, 4);
  lua_rawseti(state, -2, 1);
  set_kind(state, skill_key);
  return 1;
}

int begin_skill(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  check_node_name(state, "k.skill", place);
  lua_settop(state, 1);
  lua_pushstring(state, place.chunk);
  lua_pushinteger(state, place.line);
  lua_pushcclosure(state, finish_skill, 3);
  return 1;
}

}  // namespace

bool push_skill(lua_State* state, int index) {
  if (!lua_istable(state, index) || !is_kind(state, index, skill_key)) return false;
  lua_rawgeti(state, index, 1);
  return true;
}

void open_skills(lua_State* state) {
  const luaL_Reg functions[] = {{"__call", name_state}, {"__newindex", refuse_change}};
  open_kind(state, skill_key, functions);
  lua_pushcfunction(state, begin_skill);
  lua_setfield(state, -2, "skill");
}

}  // namespace kadans

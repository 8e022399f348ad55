#include "chart_nodes.h"

#include <cmath>
#include <cstring>
#include <initializer_list>

#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const char node_key = 0;
constexpr std::size_t name_max = 64, text_max = 256;  // characters: charts keep them outside the script's memory

constexpr double node_instructions = 300, transition_instructions = 110;  // to check one

constexpr const char* behavior_keys[] = {"version", "controls", "vars",   "args", "migrate", "initial", "always",
                                         "enter",   "exit",     "during", "run",  "endless", nullptr};
constexpr const char* state_keys[] = {"initial", "enter", "exit", "during", "run", "always", "endless", nullptr};
constexpr const char* parallel_keys[] = {"enter", "exit", "during", "run", "always", nullptr};
constexpr const char* final_keys[] = {"outcome", "enter", nullptr};
constexpr const char* history_keys[] = {"deep", "to", nullptr};
constexpr const char* transition_keys[] = {"when", "on", "after", "to", "why", "action", nullptr};

const char* const* keys_of(NodeKind kind) noexcept {
  switch (kind) {
    case NodeKind::behavior:
      return behavior_keys;
    case NodeKind::parallel:
      return parallel_keys;
    case NodeKind::final_state:
      return final_keys;
    case NodeKind::history:
      return history_keys;
    default:
      return state_keys;
  }
}

// The type that a key must have, in words of lua_typename; nullptr: checked elsewhere.
const char* wanted_type(const char* key) noexcept {
  for (const char* name : {"enter", "exit", "during", "run", "migrate", "when", "action"}) {
    if (std::strcmp(key, name) == 0) return "function";
  }
  for (const char* name : {"initial", "controls", "outcome", "to", "why", "on"}) {
    if (std::strcmp(key, name) == 0) return "string";
  }
  for (const char* name : {"vars", "args", "always"}) {
    if (std::strcmp(key, name) == 0) return "table";
  }
  if (std::strcmp(key, "version") == 0) return "number";
  return std::strcmp(key, "deep") == 0 || std::strcmp(key, "endless") == 0 ? "boolean" : nullptr;
}

void check_types(lua_State* state, int table, const ScriptPlace& place, const char* const* names) {
  for (; *names != nullptr; ++names) {
    lua_getfield(state, table, *names);
    const char* wanted = wanted_type(*names);
    if (!lua_isnil(state, -1) && wanted != nullptr && std::strcmp(luaL_typename(state, -1), wanted) != 0) {
      raise_at(state, place, *names, "'%s' must be a %s, not a %s", *names, wanted, luaL_typename(state, -1));
    }
    if (lua_type(state, -1) == LUA_TSTRING && lua_objlen(state, -1) > text_max) {
      raise_at(state, place, *names, "'%s' is longer than %d characters", *names, static_cast<int>(text_max));
    }
    lua_pop(state, 1);
  }
}

void check_after(lua_State* state, int table, const ScriptPlace& place) {
  lua_getfield(state, table, "after");
  std::size_t number = 0;
  if (!lua_isnil(state, -1) && !is_parameter(state, -1, &number)) {
    const bool good =
        lua_type(state, -1) == LUA_TNUMBER && lua_tonumber(state, -1) >= 0 && std::isfinite(lua_tonumber(state, -1));
    if (!good) raise_at(state, place, "after", "'after' must be seconds >= 0, or a parameter from k.params");
  }
  lua_pop(state, 1);
}

void check_transition(lua_State* state, int table, const ScriptPlace& place) {
  core_of(state).budget.charge(state, transition_instructions);
  lua_getfield(state, table, "to");
  const char* to = lua_tostring(state, -1);
  ScriptPlace nearer = place;
  if (to == nullptr) {
    lua_getfield(state, table, "on");
    const char* on = lua_tostring(state, -1);
    raise_at(state, place, on, "a transition needs 'to': the state it leads to");
  }
  check_keys(state, table, nearer, "a transition", transition_keys);
  check_types(state, table, nearer, transition_keys);
  check_after(state, table, nearer);
  lua_pop(state, 1);
}

void check_transitions(lua_State* state, int list, const ScriptPlace& place, bool nodes_too) {
  const int count = static_cast<int>(lua_objlen(state, list));
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, list, i);
    const int entry = lua_gettop(state);
    NodeKind kind{};
    if (is_node(state, entry, &kind)) {
      if (!nodes_too)
        raise_at(state, place, node_name(state, entry), "only transitions belong here, not a %s", node_word(kind));
    } else if (lua_isfunction(state, entry)) {
      raise_at(state, place, nullptr, "%d: a k.state, k.call or other part without its { ... }?", i);
    } else if (!lua_istable(state, entry)) {
      raise_at(state, place, nullptr, "entry %d must be a state or a transition, not a %s", i,
               luaL_typename(state, entry));
    } else {
      check_transition(state, entry, place);
    }
    lua_pop(state, 1);
  }
}

// [-1 +1] The body at the top becomes a node.
void make_node(lua_State* state, NodeKind kind, const char* name, const ScriptPlace& place) {
  lua_createtable(state, 0, 5);
  lua_insert(state, -2);
  lua_setfield(state, -2, "body");
  lua_pushinteger(state, static_cast<int>(kind));
  lua_setfield(state, -2, "kind");
  lua_pushstring(state, name);
  lua_setfield(state, -2, "name");
  lua_pushstring(state, place.chunk);
  lua_setfield(state, -2, "chunk");
  lua_pushinteger(state, place.line);
  lua_setfield(state, -2, "line");
  lua_pushlightuserdata(state, const_cast<char*>(&node_key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  lua_setmetatable(state, -2);
}

// Upvalues: kind, name, chunk, line. Takes the body.
int finish_node(lua_State* state) {
  const auto kind = static_cast<NodeKind>(lua_tointeger(state, lua_upvalueindex(1)));
  const char* name = lua_tostring(state, lua_upvalueindex(2));
  const ScriptPlace place{lua_tostring(state, lua_upvalueindex(3)),
                          static_cast<int>(lua_tointeger(state, lua_upvalueindex(4)))};
  if (!lua_istable(state, 1)) {
    return raise_at(state, place, nullptr, "%s \"%s\" needs a table { ... }", node_word(kind), name);
  }
  lua_settop(state, 1);
  core_of(state).budget.charge(state, node_instructions);
  check_keys(state, 1, place, node_word(kind), keys_of(kind));
  check_types(state, 1, place, keys_of(kind));
  check_transitions(state, 1, place, true);
  lua_getfield(state, 1, "always");
  if (lua_istable(state, 2)) check_transitions(state, 2, place, false);
  lua_settop(state, 1);
  make_node(state, kind, name, place);
  return 1;
}

bool good_name(const char* name) noexcept {
  if (*name == '\0') return false;
  return std::strspn(name, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_") == std::strlen(name);
}

// k.state "name" { ... } and its kin; upvalue: kind.
int begin_node(lua_State* state) {
  const auto kind = static_cast<NodeKind>(lua_tointeger(state, lua_upvalueindex(1)));
  const ScriptPlace place = calling_place(state);
  if (lua_type(state, 1) != LUA_TSTRING) return raise_at(state, place, nullptr, "%s needs a name", node_word(kind));
  const char* name = lua_tostring(state, 1);
  if (lua_objlen(state, 1) > name_max) {
    return raise_at(state, place, nullptr, "%s: a name has at most %d characters", node_word(kind),
                    static_cast<int>(name_max));
  }
  if (!good_name(name)) {
    return raise_at(state, place, name, "%s: a name is letters, digits and '_', not \"%s\"", node_word(kind), name);
  }
  lua_settop(state, 1);
  lua_pushinteger(state, static_cast<int>(kind));
  lua_insert(state, 1);
  lua_pushstring(state, place.chunk);
  lua_pushinteger(state, place.line);
  lua_pushcclosure(state, finish_node, 4);
  return 1;
}

// k.call "name" or k.call "name" { argument = value }: a node at once, that can be called with the arguments.
int make_call(lua_State* state) {
  const ScriptPlace place = calling_place(state);
  if (lua_type(state, 1) != LUA_TSTRING) return raise_at(state, place, nullptr, "k.call needs the name of a behavior");
  lua_settop(state, 1);
  charge_text(state, static_cast<double>(lua_objlen(state, 1)));
  lua_newtable(state);
  make_node(state, NodeKind::call, lua_tostring(state, 1), place);
  return 1;
}

int take_arguments(lua_State* state) {  // (node, arguments)
  NodeKind kind{};
  const bool call = is_node(state, 1, &kind) && kind == NodeKind::call;
  if (!call || !lua_istable(state, 2)) return luaL_error(state, "only k.call takes arguments, in a table { ... }");
  lua_settop(state, 2);
  lua_setfield(state, 1, "body");
  return 1;
}

}  // namespace

const char* node_word(NodeKind kind) noexcept {
  constexpr const char* words[] = {"k.behavior", "k.state", "k.parallel", "k.region", "k.final", "k.history", "k.call"};
  return words[static_cast<int>(kind)];
}

bool is_node(lua_State* state, int index, NodeKind* kind) {
  if (!lua_istable(state, index) || lua_getmetatable(state, index) == 0) return false;
  lua_pushlightuserdata(state, const_cast<char*>(&node_key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  const bool same = lua_rawequal(state, -1, -2) != 0;
  lua_pop(state, 2);
  if (!same) return false;
  lua_pushvalue(state, index);
  lua_getfield(state, -1, "kind");
  *kind = static_cast<NodeKind>(lua_tointeger(state, -1));
  lua_pop(state, 2);
  return true;
}

const char* node_name(lua_State* state, int index) {
  lua_getfield(state, index, "name");
  const char* name = lua_tostring(state, -1);
  lua_pop(state, 1);
  return name;  // anchored by the node
}

ScriptPlace node_place(lua_State* state, int index) {
  lua_getfield(state, index, "chunk");
  lua_getfield(state, index, "line");
  const ScriptPlace place{lua_tostring(state, -2), static_cast<int>(lua_tointeger(state, -1))};
  lua_pop(state, 2);
  return place;
}

void push_node_body(lua_State* state, int index) { lua_getfield(state, index, "body"); }

void open_nodes(lua_State* state) {
  lua_pushlightuserdata(state, const_cast<char*>(&node_key));
  lua_createtable(state, 0, 2);
  lua_pushcfunction(state, take_arguments);
  lua_setfield(state, -2, "__call");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_rawset(state, LUA_REGISTRYINDEX);
  constexpr NodeKind kinds[] = {NodeKind::behavior, NodeKind::state,       NodeKind::parallel,
                                NodeKind::region,   NodeKind::final_state, NodeKind::history};
  for (const NodeKind kind : kinds) {
    lua_pushinteger(state, static_cast<int>(kind));
    lua_pushcclosure(state, begin_node, 1);
    lua_setfield(state, -2, node_word(kind) + 2);
  }
  lua_pushcfunction(state, make_call);
  lua_setfield(state, -2, "call");
}

}  // namespace kadans

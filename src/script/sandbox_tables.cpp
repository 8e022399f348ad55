// The table library under a budget, and `pairs` in an order that is the same in every run: numbers, then strings, each
// sorted. (LuaJIT's own order of string keys differs from process to process.)
#include <algorithm>
#include <cmath>
#include <cstring>

#include "library_function.h"
#include "lua_core.h"
#include "sandbox.h"

namespace kadans {
namespace {

struct Key {
  int rank;  // 0: number, 1: string, 2: boolean
  lua_Number number;
  const char* text;
  std::size_t length;
};

bool before(const Key& a, const Key& b) noexcept {
  if (a.rank != b.rank) return a.rank < b.rank;
  if (a.rank != 1) return a.number < b.number;
  const int order = std::memcmp(a.text, b.text, std::min(a.length, b.length));
  return order != 0 ? order < 0 : a.length < b.length;
}

Key key_at_top(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER:
      return {0, lua_tonumber(state, index), nullptr, 0};
    case LUA_TSTRING: {
      Key key{1, 0, nullptr, 0};
      key.text = lua_tolstring(state, index, &key.length);
      return key;
    }
    case LUA_TBOOLEAN:
      return {2, lua_toboolean(state, index) != 0 ? 1.0 : 0.0, nullptr, 0};
    default:
      luaL_error(state, "pairs: keys of type %s have no order", luaL_typename(state, index));
      return {};
  }
}

// [-0 +1] The keys of the table at `table` as a sorted array.
void push_sorted_keys(lua_State* state, int table) {
  std::size_t count = 0;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) ++count;
  core_of(state).budget.charge(state, 2.0 * static_cast<double>(count));
  auto* keys = static_cast<Key*>(lua_newuserdata(state, (count + 1) * sizeof(Key)));
  std::size_t at = 0;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) keys[at++] = key_at_top(state, -2);
  std::sort(keys, keys + count, before);
  lua_createtable(state, static_cast<int>(count), 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (keys[i].rank == 0) {
      lua_pushnumber(state, keys[i].number);
    } else if (keys[i].rank == 1) {
      lua_pushlstring(state, keys[i].text, keys[i].length);
    } else {
      lua_pushboolean(state, keys[i].number != 0 ? 1 : 0);
    }
    lua_rawseti(state, -2, static_cast<int>(i + 1));
  }
  lua_remove(state, -2);
}

// Upvalues: the table, its sorted keys, how many were visited. Keys that are gone are passed over.
int next_pair(lua_State* state) {
  auto visited = static_cast<int>(lua_tointeger(state, lua_upvalueindex(3)));
  for (;;) {
    lua_settop(state, 0);
    lua_rawgeti(state, lua_upvalueindex(2), ++visited);
    if (lua_isnil(state, 1)) return 1;
    lua_pushvalue(state, 1);
    lua_rawget(state, lua_upvalueindex(1));
    if (!lua_isnil(state, 2)) break;
  }
  lua_pushinteger(state, visited);
  lua_replace(state, lua_upvalueindex(3));
  return 2;
}

void check_writable(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  if (push_content(state, 1)) luaL_error(state, "this table is read-only");
}

// [-0 +0] For every element of the table that is the first argument, so much.
void charge_elements(lua_State* state, double each) {
  core_of(state).budget.charge(state, static_cast<double>(lua_objlen(state, 1)) * each);
}

// insert(table [, position], value), remove(table [, position]): as in Lua; in the middle all elements behind move.
int insert(lua_State* state) {
  check_writable(state);
  charge_elements(state, lua_gettop(state) > 2 ? 0.25 : 0);
  return forward(state);
}
int remove(lua_State* state) {
  check_writable(state);
  charge_elements(state, lua_gettop(state) > 1 ? 0.25 : 0);
  return forward(state);
}

// concat, maxn: as in Lua.
int concat(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  charge_elements(state, 1);
  return forward_text(state);
}

// sort(table [, before]): as in Lua.
int sort(lua_State* state) {
  check_writable(state);
  charge_elements(state, std::log2(static_cast<double>(lua_objlen(state, 1)) + 1));
  return forward_nested(state, "table.sort");
}

}  // namespace

int sandbox_pairs(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  if (push_content(state, 1)) lua_replace(state, 1);
  push_sorted_keys(state, 1);
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, next_pair, 3);
  return 1;
}

void open_tables(lua_State* state) {
  wrap(state, "insert", insert);
  wrap(state, "remove", remove);
  wrap(state, "concat", concat);
  wrap(state, "maxn", concat);
  wrap(state, "sort", sort);
}

}  // namespace kadans

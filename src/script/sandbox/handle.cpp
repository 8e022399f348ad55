#include "handle.h"

#include "sandbox.h"

namespace kadans {

void open_kind(lua_State* state, const HandleKey& key) {
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_pushlightuserdata(state, const_cast<HandleKey*>(&key));
  lua_insert(state, -2);
  lua_rawset(state, LUA_REGISTRYINDEX);
}

void set_functions(lua_State* state, std::span<const luaL_Reg> functions) {
  for (const luaL_Reg& function : functions) {
    lua_pushcfunction(state, function.func);
    lua_setfield(state, -2, function.name);
  }
}

void open_kind(lua_State* state, const HandleKey& key, std::span<const luaL_Reg> functions) {
  lua_createtable(state, 0, static_cast<int>(functions.size()) + 1);
  set_functions(state, functions);
  open_kind(state, key);
}

void open_kind(lua_State* state, const HandleKey& key, std::span<const luaL_Reg> methods, lua_CFunction read_field) {
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, static_cast<int>(methods.size()) + 1);
  set_functions(state, methods);
  lua_pushcclosure(state, read_field, 1);
  lua_setfield(state, -2, "__index");
  open_kind(state, key);
}

void set_kind(lua_State* state, const HandleKey& key) {
  lua_pushlightuserdata(state, const_cast<HandleKey*>(&key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  lua_setmetatable(state, -2);
}

void push_reader(lua_State* state, lua_CFunction read, lua_CFunction write) {
  const int content = lua_gettop(state);
  lua_newtable(state);
  lua_createtable(state, 0, 3);
  lua_pushvalue(state, content);
  lua_pushcclosure(state, read, 1);
  lua_setfield(state, -2, "__index");
  lua_pushcfunction(state, write);
  lua_setfield(state, -2, "__newindex");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_setmetatable(state, -2);
  lua_replace(state, content);
}

bool is_kind(lua_State* state, int index, const HandleKey& key) noexcept {
  if (lua_getmetatable(state, index) == 0) return false;
  lua_pushlightuserdata(state, const_cast<HandleKey*>(&key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  const bool same = lua_rawequal(state, -1, -2) != 0;
  lua_pop(state, 2);
  return same;
}

void* to_handle(lua_State* state, int index, const HandleKey& key) noexcept {
  const bool is = lua_type(state, index) == LUA_TUSERDATA && is_kind(state, index, key);
  return is ? lua_touserdata(state, index) : nullptr;
}

int push_method(lua_State* state, const char* what) {
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(1));
  if (lua_isnil(state, -1)) return raise_unknown_field(state, what, lua_upvalueindex(1), 2);
  return 1;
}

}  // namespace kadans

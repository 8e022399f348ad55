#include "vars_transfer.h"

#include <cstring>

#include "script/motion/motion.h"

namespace kadans {
namespace {

void push_motion_across(lua_State* from, int index, lua_State* to) {
  Motion* motion = to_motion(from, index);
  if (motion == nullptr) {
    luaL_error(to, "vars hold a userdata: a reload carries plain data and motions");
    return;  // it has raised
  }
  Motion* copy = push_motion(to, motion->count);
  std::memcpy(static_cast<void*>(copy), motion, sizeof(Motion) + motion->count * sizeof(SetpointId));
}

void push_table_across(lua_State* from, int index, lua_State* to, int depth) {
  if (depth > vars_depth_max) luaL_error(to, "vars are nested too deeply to be carried through a reload");
  if (lua_checkstack(from, 8) == 0) luaL_error(to, "vars cannot be read");
  luaL_checkstack(to, 8, "vars are nested too deeply");
  lua_newtable(to);
  for (lua_pushnil(from); lua_next(from, index) != 0; lua_pop(from, 1)) {
    const int value = lua_gettop(from);
    push_copy_across(from, value - 1, to, depth + 1);
    push_copy_across(from, value, to, depth + 1);
    lua_rawset(to, -3);
  }
}

}  // namespace

void push_copy_across(lua_State* from, int index, lua_State* to, int depth) {
  switch (lua_type(from, index)) {
    case LUA_TNIL:
      return lua_pushnil(to);
    case LUA_TBOOLEAN:
      return lua_pushboolean(to, lua_toboolean(from, index));
    case LUA_TNUMBER:
      return lua_pushnumber(to, lua_tonumber(from, index));
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(from, index, &length);
      return lua_pushlstring(to, text, length);
    }
    case LUA_TTABLE:
      return push_table_across(from, index, to, depth);
    case LUA_TUSERDATA:
      return push_motion_across(from, index, to);
    default:
      luaL_error(to, "vars hold a %s: a reload carries plain data and motions", luaL_typename(from, index));
  }
}

}  // namespace kadans

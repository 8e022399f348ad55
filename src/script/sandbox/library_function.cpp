#include "library_function.h"

#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr int callback_depth_max = 16;  // C frames of gsub and print are large
constexpr double text_bytes_per_instruction = 12;

}  // namespace

void wrap(lua_State* state, const char* name, lua_CFunction function) {
  lua_getfield(state, -1, name);
  lua_pushcclosure(state, function, 1);
  lua_setfield(state, -2, name);
}

void set_function(lua_State* state, int table, const char* name, lua_CFunction function) {
  lua_pushcfunction(state, function);
  lua_setfield(state, table, name);
}

int forward(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

int forward_text(lua_State* state) {
  const int results = forward(state);
  if (results > 0 && lua_type(state, 1) == LUA_TSTRING) charge_text(state, static_cast<double>(lua_objlen(state, 1)));
  return results;
}

void begin_callback(lua_State* state, const char* name) {
  LuaCore& core = core_of(state);
  if (core.depth >= callback_depth_max) luaL_error(state, "%s is nested too deeply", name);
  ++core.depth;
}

void end_callback(lua_State* state) noexcept { --core_of(state).depth; }

void charge_text(lua_State* state, double bytes) {
  core_of(state).budget.charge(state, bytes / text_bytes_per_instruction);
}

std::int32_t to_place(lua_Number number) noexcept {
  return number > -2147483649.0 && number < 2147483648.0 ? static_cast<std::int32_t>(number) : INT32_MIN;
}

std::int32_t optional_place(lua_State* state, int index, std::int32_t otherwise) {
  return lua_isnoneornil(state, index) ? otherwise : to_place(luaL_checknumber(state, index));
}

}  // namespace kadans

// m.<object>: a control object as a behavior sees it. Everything is checked before the first command is made.
#include "object_binding.h"

#include <algorithm>
#include <cstring>

#include "bindings.h"
#include "script/check/hint.h"
#include "script/motion/motion_targets.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const char object_key = 0;

// object:setpoint(name) -> number: where it is on its way now.
int setpoint(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  return lua_pushnumber(state, present_setpoint(state, read_setpoint(state, 2, object)).value), 1;
}

ParameterId read_parameter(lua_State* state, int index, const ObjectInfo& object) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const char* name = luaL_checkstring(state, index);
  for (const ParameterId id : object.parameters) {
    if (std::strcmp(short_name(object, catalog.parameters.info(id).name), name) == 0) return id;
  }
  const Hint hint = make_hint(state, name, [&](auto& names) {
    for (const ParameterId id : object.parameters)
      names.emplace_back(short_name(object, catalog.parameters.info(id).name));
  });
  luaL_error(state, "'%s' has no parameter '%s'%s", object.name.c_str(), name, hint.data());
  return 0;
}

// object:parameter(name) -> number: what it was set to last.
int parameter(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  const ParameterId id = read_parameter(state, 2, object);
  return lua_pushnumber(state, bindings_of(state).catalog->parameters.newest(id)), 1;
}

// object:set_parameter(name, value) -> true | nil, "queue_full".
int set_parameter(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  Bindings& bindings = bindings_of(state);
  const ParameterId id = read_parameter(state, 2, object);
  const double value = luaL_checknumber(state, 3);
  const Parameter& info = bindings.catalog->parameters.info(id);
  check_range(state, info.name.c_str(), info.unit.c_str(), value, info.min, info.max);
  if (!bindings.send({.kind = CommandKind::set_parameter, .index = id, .value = value})) return queue_full(state);
  return lua_pushboolean(state, 1), 1;
}

// object:set_gains(preset) -> true | nil, "queue_full".
int set_gains(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  Bindings& bindings = bindings_of(state);
  const char* name = luaL_checkstring(state, 2);
  for (const Preset& preset : object.presets) {
    if (preset.name != name) continue;
    for (const auto& [id, value] : preset.values) {
      if (!bindings.send({.kind = CommandKind::set_parameter, .index = id, .value = value})) return queue_full(state);
    }
    return lua_pushboolean(state, 1), 1;
  }
  const Hint hint = make_hint(state, name, [&](auto& names) { names = names_of(object.presets); });
  return luaL_error(state, "'%s' has no gains '%s'%s", object.name.c_str(), name, hint.data());
}

}  // namespace

const ObjectInfo& check_object(lua_State* state, std::uint32_t& number) {
  const void* handle = nullptr;
  if (lua_type(state, 1) == LUA_TUSERDATA && lua_getmetatable(state, 1) != 0) {
    lua_pushlightuserdata(state, const_cast<char*>(&object_key));
    lua_rawget(state, LUA_REGISTRYINDEX);
    if (lua_rawequal(state, -1, -2) != 0) handle = lua_touserdata(state, 1);
    lua_pop(state, 2);
  }
  if (handle == nullptr) luaL_error(state, "call it on a control object, with a colon: m.object:method(...)");
  number = handle != nullptr ? *static_cast<const std::uint32_t*>(handle) : 0;
  return bindings_of(state).catalog->objects[number];
}

const char* short_name(const ObjectInfo& object, const std::string& name) noexcept {
  return name.c_str() + std::min(name.size(), object.name.size() + 1);
}

void check_range(lua_State* state, const char* name, const char* unit, double value, double min, double max) {
  if (value >= min && value <= max) return;
  luaL_error(state, "%s = %f is outside its range %f..%f %s", name, value, min, max, unit);
}

int queue_full(lua_State* state) { return lua_pushnil(state), lua_pushliteral(state, "queue_full"), 2; }

void push_object(lua_State* state, std::uint32_t object) {
  *static_cast<std::uint32_t*>(lua_newuserdata(state, sizeof object)) = object;
  lua_pushlightuserdata(state, const_cast<char*>(&object_key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  lua_setmetatable(state, -2);
}

void open_objects(lua_State* state) {
  const luaL_Reg methods[] = {
      {"setpoint", setpoint}, {"parameter", parameter}, {"set_gains", set_gains}, {"set_parameter", set_parameter}};
  lua_pushlightuserdata(state, const_cast<char*>(&object_key));
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 8);
  for (const luaL_Reg& method : methods) {
    lua_pushcfunction(state, method.func);
    lua_setfield(state, -2, method.name);
  }
  open_motion_methods(state);
  make_read_only(state, "a control object");
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_rawset(state, LUA_REGISTRYINDEX);
}

}  // namespace kadans

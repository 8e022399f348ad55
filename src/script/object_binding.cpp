// m.<object>: a control object as a behavior sees it. Everything is checked before the first command is made.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bindings.h"
#include "hint.h"
#include "place.h"
#include "sandbox.h"

namespace kadans {
namespace {

const char object_key = 0;
constexpr double time_max_s = 600;

struct Target {
  SetpointId id;
  double value;
};
using Targets = std::array<Target, max_joints>;

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

int queue_full(lua_State* state) { return lua_pushnil(state), lua_pushliteral(state, "queue_full"), 2; }

// The name without the object's in front.
const char* short_name(const ObjectInfo& object, const std::string& name) {
  return name.c_str() + std::min(name.size(), object.name.size() + 1);
}

// How the set-point of a joint's position is called, or nothing.
const Setpoint* position_setpoint(const Catalog& catalog, const ObjectInfo& object, std::size_t joint, SetpointId& id) {
  constexpr std::string_view ending = ".position_rad";
  for (const SetpointId candidate : object.setpoints) {
    const Setpoint& setpoint = catalog.setpoints[candidate];
    if (setpoint.joint != joint || !std::string_view(setpoint.name).ends_with(ending)) continue;
    id = candidate;
    return &setpoint;
  }
  return nullptr;
}

void check_range(lua_State* state, const char* name, const char* unit, double value, double min, double max) {
  if (value >= min && value <= max) return;
  luaL_error(state, "%s = %f is outside its range %f..%f %s", name, value, min, max, unit);
}

// { time_s = } at `index`; `needed`: there is no default.
double check_time(lua_State* state, int index, const char* method, bool needed) {
  static constexpr const char* keys[] = {"time_s", nullptr};
  if (lua_isnoneornil(state, index) && !needed) return 0;
  if (!lua_istable(state, index)) luaL_error(state, "%s needs { time_s = seconds } at the end", method);
  check_keys(state, index, calling_place(state), method, keys);
  lua_getfield(state, index, "time_s");
  const double time_s = lua_type(state, -1) == LUA_TNUMBER ? lua_tonumber(state, -1) : std::nan("");
  lua_pop(state, 1);
  if (!(time_s >= 0 && time_s <= time_max_s)) luaL_error(state, "%s: time_s must be a number in 0..600 s", method);
  return time_s;
}

std::uint32_t pose_targets(lua_State* state, const ObjectInfo& object, const char* name, Targets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const PoseInfo* pose = nullptr;
  for (const PoseInfo& candidate : catalog.poses) {
    if (candidate.name == name) pose = &candidate;
  }
  if (pose == nullptr) {
    const Hint hint = make_hint(name, [&](auto& names) {
      for (const PoseInfo& known : catalog.poses) names.push_back(known.name);
    });
    luaL_error(state, "unknown pose '%s'%s", name, hint.data());
  }
  std::uint32_t count = 0;
  for (const auto& [joint, position_rad] : pose->position_rad) {
    SetpointId id = 0;
    const Setpoint* setpoint = position_setpoint(catalog, object, joint, id);
    if (setpoint == nullptr) continue;  // a joint that another object moves, or none
    check_range(state, setpoint->name.c_str(), "rad", position_rad, setpoint->min, setpoint->max);
    targets[count++] = {id, position_rad};
  }
  if (count == 0) luaL_error(state, "pose '%s' holds no joint of '%s'", name, object.name.c_str());
  return count;
}

std::uint32_t table_targets(lua_State* state, const ObjectInfo& object, Targets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  std::uint32_t count = 0, wanted = 0;
  for (const std::size_t joint : object.joints) {  // in the robot's order, so that every run sends the same
    SetpointId id = 0;
    const Setpoint* setpoint = position_setpoint(catalog, object, joint, id);
    if (setpoint == nullptr) continue;
    lua_getfield(state, 2, catalog.model->joints[joint].name.c_str());
    if (!lua_isnil(state, -1)) {
      if (lua_type(state, -1) != LUA_TNUMBER)
        luaL_error(state, "%s must be a number in rad, not a %s", catalog.model->joints[joint].name.c_str(),
                   luaL_typename(state, -1));
      check_range(state, setpoint->name.c_str(), "rad", lua_tonumber(state, -1), setpoint->min, setpoint->max);
      targets[count++] = {id, lua_tonumber(state, -1)};
    }
    lua_pop(state, 1);
  }
  for (lua_pushnil(state); lua_next(state, 2) != 0; lua_pop(state, 1)) ++wanted;
  if (wanted == count) return count;
  std::array<const char*, max_joints + 1> names{};
  std::size_t known = 0;
  SetpointId ignored = 0;
  for (const std::size_t joint : object.joints) {
    if (position_setpoint(catalog, object, joint, ignored) != nullptr)
      names[known++] = catalog.model->joints[joint].name.c_str();
  }
  for (const Joint& joint : catalog.model->joints) {
    lua_getfield(state, 2, joint.name.c_str());
    const bool foreign = !lua_isnil(state, -1) && std::none_of(names.data(), names.data() + known,
                                                               [&](const char* own) { return joint.name == own; });
    if (foreign) luaL_error(state, "'%s' does not move the joint '%s'", object.name.c_str(), joint.name.c_str());
    lua_pop(state, 1);
  }
  check_keys(state, 2, calling_place(state), "this pose", names.data());
  luaL_error(state, "a pose is a table joint = position in rad");
  return 0;
}

int start_motion(lua_State* state, std::uint32_t object, const Target* targets, std::uint32_t count, double time_s) {
  Bindings& bindings = bindings_of(state);
  Motion* motion = push_motion(state, count);
  motion->object = object;
  motion->duration_s = time_s;
  motion->asked_ns = bindings.now_ns;
  for (std::uint32_t i = 0; i < count; ++i) motion->setpoints()[i] = targets[i].id;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Command command{
        .kind = CommandKind::set_point, .index = targets[i].id, .value = targets[i].value, .duration_s = time_s};
    if (!bindings.send(command)) return queue_full(state);
  }
  if (bindings.motion_count == bindings.motions.size()) return queue_full(state);
  bindings.motions[bindings.motion_count++] = motion;
  return 1;
}

// object:move(pose, { time_s = }) -> motion | nil, "queue_full". The pose is a name, or a table joint = rad.
int move(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  const double time_s = check_time(state, 3, "move", true);
  Targets targets;
  std::uint32_t count = 0;
  if (lua_istable(state, 2)) {
    count = table_targets(state, object, targets);
  } else if (lua_type(state, 2) == LUA_TSTRING) {
    count = pose_targets(state, object, lua_tostring(state, 2), targets);
  } else {
    return luaL_error(state, "move needs a pose: its name, or a table joint = position in rad");
  }
  return start_motion(state, number, targets.data(), count, time_s);
}

// object:set(setpoint, value [, { time_s = }]) -> motion | nil, "queue_full".
int set(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  const Catalog& catalog = *bindings_of(state).catalog;
  const char* name = luaL_checkstring(state, 2);
  const double value = luaL_checknumber(state, 3);
  const double time_s = check_time(state, 4, "set", false);
  for (const SetpointId id : object.setpoints) {
    const Setpoint& setpoint = catalog.setpoints[id];
    if (std::strcmp(short_name(object, setpoint.name), name) != 0) continue;
    check_range(state, setpoint.name.c_str(), setpoint.unit.c_str(), value, setpoint.min, setpoint.max);
    const Target target{id, value};
    return start_motion(state, number, &target, 1, time_s);
  }
  const Hint hint = make_hint(name, [&](auto& names) {
    for (const SetpointId id : object.setpoints) names.emplace_back(short_name(object, catalog.setpoints[id].name));
  });
  return luaL_error(state, "'%s' has no set-point '%s'%s", object.name.c_str(), name, hint.data());
}

int send_parameter(lua_State* state, const ObjectInfo& object, const char* name, double value, bool check_only) {
  Bindings& bindings = bindings_of(state);
  const Catalog& catalog = *bindings.catalog;
  for (const ParameterId id : object.parameters) {
    const Parameter& parameter = catalog.parameters.info(id);
    if (std::strcmp(short_name(object, parameter.name), name) != 0) continue;
    check_range(state, parameter.name.c_str(), parameter.unit.c_str(), value, parameter.min, parameter.max);
    if (check_only) return 1;
    return bindings.send({.kind = CommandKind::set_parameter, .index = id, .value = value}) ? 1 : 0;
  }
  const Hint hint = make_hint(name, [&](auto& names) {
    for (const ParameterId id : object.parameters)
      names.emplace_back(short_name(object, catalog.parameters.info(id).name));
  });
  return luaL_error(state, "'%s' has no parameter '%s'%s", object.name.c_str(), name, hint.data());
}

// object:set_parameter(name, value) -> true | nil, "queue_full".
int set_parameter(lua_State* state) {
  std::uint32_t number = 0;
  const ObjectInfo& object = check_object(state, number);
  const char* name = luaL_checkstring(state, 2);
  const double value = luaL_checknumber(state, 3);
  if (send_parameter(state, object, name, value, false) == 0) return queue_full(state);
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
  const Hint hint = make_hint(name, [&](auto& names) {
    for (const Preset& preset : object.presets) names.push_back(preset.name);
  });
  return luaL_error(state, "'%s' has no gains '%s'%s", object.name.c_str(), name, hint.data());
}

}  // namespace

void push_object(lua_State* state, std::uint32_t object) {
  *static_cast<std::uint32_t*>(lua_newuserdata(state, sizeof object)) = object;
  lua_pushlightuserdata(state, const_cast<char*>(&object_key));
  lua_rawget(state, LUA_REGISTRYINDEX);
  lua_setmetatable(state, -2);
}

void open_objects(lua_State* state) {
  const luaL_Reg methods[] = {{"move", move}, {"set", set}, {"set_gains", set_gains}, {"set_parameter", set_parameter}};
  lua_pushlightuserdata(state, const_cast<char*>(&object_key));
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 4);
  for (const luaL_Reg& method : methods) {
    lua_pushcfunction(state, method.func);
    lua_setfield(state, -2, method.name);
  }
  make_read_only(state, "a control object");
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_rawset(state, LUA_REGISTRYINDEX);
}

}  // namespace kadans

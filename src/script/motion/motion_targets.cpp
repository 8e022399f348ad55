#include "motion_targets.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "script/bindings/bindings.h"
#include "script/check/hint.h"
#include "script/lua/script_error.h"

namespace kadans {
namespace {

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

void add(MotionTargets& targets, SetpointId id, double value) {
  targets.all[targets.count++] = {.id = id, .value = value, .from = {}};
}

void named_pose(lua_State* state, const ObjectInfo& object, const char* name, MotionTargets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const PoseInfo* pose = nullptr;
  for (const PoseInfo& candidate : catalog.poses) {
    if (candidate.name == name) pose = &candidate;
  }
  if (pose == nullptr) {
    const Hint hint = make_hint(state, name, [&](auto& names) { names = names_of(catalog.poses); });
    luaL_error(state, "unknown pose '%s'%s", name, hint.data());
  }
  for (const auto& [joint, position_rad] : pose->position_rad) {
    SetpointId id = 0;  // nothing for a joint that another object moves, or none
    if (position_setpoint(catalog, object, joint, id) != nullptr) add(targets, id, position_rad);
  }
  if (targets.count == 0) luaL_error(state, "pose '%s' holds no joint of '%s'", name, object.name.c_str());
}

// A key that is no joint of the object's, or not a text.
int raise_wrong_joint(lua_State* state, int index, const ObjectInfo& object) {
  const Catalog& catalog = *bindings_of(state).catalog;
  std::array<const char*, max_joints + 1> names{};
  std::size_t known = 0;
  SetpointId ignored = 0;
  for (const std::size_t joint : object.joints) {
    if (position_setpoint(catalog, object, joint, ignored) != nullptr)
      names[known++] = catalog.model->joints[joint].name.c_str();
  }
  for (const Joint& joint : catalog.model->joints) {
    lua_getfield(state, index, joint.name.c_str());
    const bool foreign = !lua_isnil(state, -1) && std::none_of(names.data(), names.data() + known,
                                                               [&](const char* own) { return joint.name == own; });
    if (foreign) luaL_error(state, "'%s' does not move the joint '%s'", object.name.c_str(), joint.name.c_str());
    lua_pop(state, 1);
  }
  check_keys(state, index, calling_place(state), "this pose", names.data());
  return luaL_error(state, "a pose is a table joint = position in rad");
}

void pose_table(lua_State* state, int index, const ObjectInfo& object, MotionTargets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  for (const std::size_t joint : object.joints) {  // in the robot's order, so that every run sends the same
    SetpointId id = 0;
    if (position_setpoint(catalog, object, joint, id) == nullptr) continue;
    const char* name = catalog.model->joints[joint].name.c_str();
    lua_getfield(state, index, name);
    if (!lua_isnil(state, -1)) {
      if (lua_type(state, -1) != LUA_TNUMBER)
        luaL_error(state, "%s must be a number in rad, not a %s", name, luaL_typename(state, -1));
      add(targets, id, lua_tonumber(state, -1));
    }
    lua_pop(state, 1);
  }
  std::uint32_t wanted = 0;
  charge_table(state, index);
  for (lua_pushnil(state); wanted <= targets.count && lua_next(state, index) != 0; lua_pop(state, 1)) ++wanted;
  if (wanted != targets.count) raise_wrong_joint(state, index, object);
}

}  // namespace

void read_pose(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets) {
  targets.count = 0;
  if (lua_istable(state, index)) return pose_table(state, index, object, targets);
  if (lua_type(state, index) != LUA_TSTRING)
    luaL_error(state, "%s needs a pose: its name, or a table joint = position in rad", called);
  named_pose(state, object, lua_tostring(state, index), targets);
}

SetpointId read_setpoint(lua_State* state, int index, const ObjectInfo& object) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const char* name = luaL_checkstring(state, index);
  for (const SetpointId id : object.setpoints) {
    if (std::strcmp(short_name(object, catalog.setpoints[id].name), name) == 0) return id;
  }
  const Hint hint = make_hint(state, name, [&](auto& names) {
    for (const SetpointId id : object.setpoints) names.emplace_back(short_name(object, catalog.setpoints[id].name));
  });
  luaL_error(state, "'%s' has no set-point '%s'%s", object.name.c_str(), name, hint.data());
  return 0;
}

SetpointState present_setpoint(lua_State* state, SetpointId id) {
  const Bindings& bindings = bindings_of(state);
  const Setpoint& setpoint = bindings.catalog->setpoints[id];
  if (setpoint.follows && id < max_setpoints_shown) {
    const SetpointStatus& now = bindings.snapshot->setpoints[id];
    if (std::isfinite(now.value)) return {now.value, now.velocity, 0};
    if (setpoint.joint < bindings.catalog->model->joints.size() && setpoint.unit == "rad") {
      const JointState& joint = bindings.snapshot->joints.joints[setpoint.joint];
      return {joint.position_rad, joint.velocity_rad_s, 0};
    }
  }
  luaL_error(state, "%s: its control object cannot say where it is; it moves by { time_s = } only",
             setpoint.name.c_str());
  return {};
}

void place_targets(lua_State* state, const MotionOptions& options, bool planned, MotionTargets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  for (std::uint32_t i = 0; i < targets.count; ++i) {
    MotionTarget& target = targets.all[i];
    const Setpoint& setpoint = catalog.setpoints[target.id];
    if (planned || options.relative) target.from = present_setpoint(state, target.id);
    if (options.relative) target.value += target.from.value;
    check_range(state, setpoint.name.c_str(), setpoint.unit.c_str(), target.value, setpoint.min, setpoint.max);
    const double fastest = setpoint.joint < catalog.model->joints.size() && setpoint.unit == "rad"
                               ? catalog.model->joints[setpoint.joint].velocity_max_rad_s
                               : 0;
    if (fastest > 0 && options.velocity_max > fastest)
      luaL_error(state, "%s: %s = %f is more than the joint's %f", setpoint.name.c_str(), options.velocity_name,
                 options.velocity_max, fastest);
  }
}

}  // namespace kadans

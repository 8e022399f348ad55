#include "motion_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "script/bindings/bindings.h"
#include "script/check/hint.h"
#include "script/lua/script_error.h"
#include "task_targets.h"

namespace kadans {
namespace {

// The set-point of a joint's position, if the object has it.
std::optional<SetpointId> position_setpoint(const Catalog& catalog, const ObjectInfo& object, std::size_t joint) {
  for (const SetpointId id : object.setpoints) {
    const Setpoint& setpoint = catalog.setpoints[id];
    if (setpoint.joint == joint && setpoint.name.ends_with(".position_rad")) return id;
  }
  return std::nullopt;
}

void named_pose(lua_State* state, const ObjectInfo& object, const char* name, MotionTargets& targets) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const PoseInfo& pose = check_named(state, catalog.poses, name, "pose");
  for (const auto& [joint, position_rad] : pose.position_rad) {  // some joints are another object's, or nobody's
    if (const auto id = position_setpoint(catalog, object, joint)) targets.add(*id, position_rad);
  }
  if (targets.count == 0) luaL_error(state, "pose '%s' holds no joint of '%s'", name, object.name.c_str());
}

// A key that is no joint of the object's, or not a text.
int raise_wrong_joint(lua_State* state, int index, const ObjectInfo& object) {
  const Catalog& catalog = *bindings_of(state).catalog;
  std::array<const char*, max_joints + 1> names{};
  std::size_t known = 0;
  for (const std::size_t joint : object.joints) {
    if (position_setpoint(catalog, object, joint)) names[known++] = catalog.model->joints[joint].name.c_str();
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
    const auto id = position_setpoint(catalog, object, joint);
    if (!id) continue;
    const char* name = catalog.model->joints[joint].name.c_str();
    lua_getfield(state, index, name);
    if (!lua_isnil(state, -1)) {
      if (lua_type(state, -1) != LUA_TNUMBER)
        luaL_error(state, "%s must be a number in rad, not a %s", name, luaL_typename(state, -1));
      targets.add(*id, lua_tonumber(state, -1));
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
  if (lua_istable(state, index) && has_tasks(*bindings_of(state).catalog, object))
    return read_tasks(state, index, object, called, targets);
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

namespace {

using Type = MotionOption::Type;

constexpr std::uint8_t move_set = MotionOption::move | MotionOption::set;
constexpr std::uint8_t limited = move_set | MotionOption::follow;
constexpr double limit_min = 0.001, velocity_most = 1000, acceleration_most = 10000;
constexpr MotionOption known_options[] = {
    {"time_s", Type::number, 0, 600, "s", nullptr, move_set | MotionOption::point,
     "Duration of the motion; 0: at once"},
    {"profile", Type::text, 0, 0, "", nullptr, move_set, "'minimum_jerk' (the default) or 'trapezoid'"},
    {"velocity_max_rad_s", Type::number, limit_min, velocity_most, "rad/s", "rad", limited,
     "Largest velocity of a trapezoidal profile"},
    {"acceleration_max_rad_s2", Type::number, limit_min, acceleration_most, "rad/s2", "rad", limited,
     "Largest acceleration of a trapezoidal profile"},
    {"velocity_max_m_s", Type::number, limit_min, velocity_most, "m/s", "m", MotionOption::set,
     "Largest velocity of a trapezoidal profile"},
    {"acceleration_max_m_s2", Type::number, limit_min, acceleration_most, "m/s2", "m", MotionOption::set,
     "Largest acceleration of a trapezoidal profile"},
    {"relative", Type::flag, 0, 0, "", nullptr, move_set | MotionOption::through,
     "Whether values are relative to the present set-points"},
    {"weight", Type::number, 0, 1000, "", nullptr, MotionOption::move, "How much the moved tasks count beside others"},
    {"priority", Type::number, 1, 2, "", nullptr, MotionOption::move,
     "1, or 2: the moved tasks get what those of 1 leave"},
    {"contacts", Type::list, 0, 0, "", nullptr, MotionOption::move, "The feet that stand; all others are free"},
};

constexpr MotionMethod methods[] = {
    {"move", MotionOption::move, " needs { time_s = seconds } at the end"},
    {"move_through", MotionOption::through, nullptr},
    {"set", MotionOption::set, nullptr},
    {"follow", MotionOption::follow, " needs { velocity_max_rad_s =, acceleration_max_rad_s2 = } at the end"}};

bool starts_with(const char* text, const char* start) noexcept {
  return std::strncmp(text, start, std::strlen(start)) == 0;
}

// What every table of this method may hold, for messages.
void check_names(lua_State* state, int index, MotionOption::Method method, const char* called) {
  std::array<const char*, std::size(known_options) + 1> names{};
  std::size_t count = 0;
  for (const MotionOption& option : known_options) {
    if ((option.methods & method) != 0) names[count++] = option.name;
  }
  check_keys(state, index, calling_place(state), called, names.data());
}

// The number at the top of the stack.
double check_number(lua_State* state, const MotionOption& option, const char* called, const char* unit) {
  if (option.length != nullptr && std::strcmp(option.length, unit) != 0)
    luaL_error(state, "%s: %s does not fit a set-point in %s", called, option.name, unit);
  const double value = lua_type(state, -1) == LUA_TNUMBER ? lua_tonumber(state, -1) : std::nan("");
  if (!(value >= option.min && value <= option.max))
    luaL_error(state, "%s: %s must be a number in %f..%f %s", called, option.name, option.min, option.max, option.unit);
  return value;
}

bool read_profile(lua_State* state, const char* called) {
  if (lua_type(state, -1) != LUA_TSTRING)
    luaL_error(state, "%s: profile must be a text, not a %s", called, luaL_typename(state, -1));
  const char* given = lua_tostring(state, -1);
  for (const char* known : motion_profiles) {
    if (std::strcmp(given, known) == 0) return known != motion_profiles[0];
  }
  const Hint hint = make_hint(state, given, [](auto& names) {
    for (const char* known : motion_profiles) names.emplace_back(known);
  });
  luaL_error(state, "%s: unknown profile '%s'%s", called, given, hint.data());
  return false;
}

// The field at the top of the stack into `options`.
void take(lua_State* state, const MotionOption& option, const char* called, const char* unit, MotionOptions& options) {
  switch (option.type) {
    case Type::text:
      options.trapezoid = read_profile(state, called);
      return;
    case Type::flag:
      if (!lua_isboolean(state, -1))
        luaL_error(state, "%s: %s must be true or false, not a %s", called, option.name, luaL_typename(state, -1));
      options.relative = lua_toboolean(state, -1) != 0;
      return;
    case Type::list:
      if (!lua_istable(state, -1))
        luaL_error(state, "%s: %s must be a list { ... }, not a %s", called, option.name, luaL_typename(state, -1));
      return;
    case Type::number:
      break;
  }
  const double value = check_number(state, option, called, unit);
  if (starts_with(option.name, "time")) {
    options.timed = true;
    options.time_s = value;
  } else if (starts_with(option.name, "weight") || starts_with(option.name, "priority")) {
    return;  // of tasks (task_targets.h)
  } else if (starts_with(option.name, "velocity")) {
    options.velocity_name = option.name;
    options.velocity_max = value;
  } else {
    options.acceleration_max = value;
  }
}

void check_together(lua_State* state, MotionOption::Method method, const char* called, const MotionOptions& options) {
  const bool one = options.velocity_max > 0 || options.acceleration_max > 0;
  const bool both = options.velocity_max > 0 && options.acceleration_max > 0;
  if (method == MotionOption::follow) {
    if (!both) luaL_error(state, "%s needs { velocity_max_rad_s =, acceleration_max_rad_s2 = } at the end", called);
    return;
  }
  if (!options.trapezoid) {
    if (one) luaL_error(state, "%s: velocity_max and acceleration_max need profile = \"trapezoid\"", called);
    if (!options.timed && method == MotionOption::move)
      luaL_error(state, "%s needs { time_s = seconds } at the end", called);
    return;
  }
  if (one && options.timed) luaL_error(state, "%s: a trapezoid takes time_s or limits, not both", called);
  if (options.timed && !(options.time_s > 0)) luaL_error(state, "%s: a trapezoid needs time_s > 0", called);
  if (!both && !options.timed)
    luaL_error(state, "%s: a trapezoid needs time_s, or velocity_max and acceleration_max", called);
}

}  // namespace

std::span<const MotionOption> motion_options() noexcept { return known_options; }
std::span<const MotionMethod> motion_methods() noexcept { return methods; }

MotionOptions read_motion_options(lua_State* state, int index, MotionOption::Method method, const char* called,
                                  const char* unit) {
  MotionOptions options;
  if (lua_isnoneornil(state, index) && (method == MotionOption::set || method == MotionOption::through)) return options;
  if (lua_istable(state, index)) {
    check_names(state, index, method, called);
    for (const MotionOption& option : known_options) {
      lua_getfield(state, index, option.name);
      if (!lua_isnil(state, -1)) take(state, option, called, unit, options);
      lua_pop(state, 1);
    }
  } else if (!lua_isnoneornil(state, index)) {
    luaL_error(state, "%s: the last argument must be a table { ... }, not a %s", called, luaL_typename(state, index));
  }
  if (method != MotionOption::through && method != MotionOption::point) check_together(state, method, called, options);
  return options;
}

}  // namespace kadans

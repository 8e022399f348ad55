// The methods of a control object that move its set-points. Everything is checked before the first command is made;
// what a method asks for goes into the tick's transaction.
#include <algorithm>
#include <cmath>

#include "engine/motion/setpoint_motions.h"
#include "kadans/control/control_object.h"
#include "motion_options.h"
#include "script/bindings/bindings.h"
#include "script/lua/script_error.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"
#include "task_targets.h"

namespace kadans {
namespace {

// A trapezoid that fills its time: with these the peak is 1.3 times the mean speed, and the acceleration that this
// takes is less than a minimum-jerk motion's. Both are limits where the motion begins at speed.
constexpr double peak_per_mean = 4, acceleration_per_way = 5.5;
constexpr double least = 1e-3;  // of a limit

// [-0 +1] The handle of a motion for commit() to number. nullptr: there is no place for it.
Motion* start_motion(lua_State* state, const ObjectInfo& object, std::uint32_t count, double duration_s) {
  Bindings& bindings = bindings_of(state);
  Motion* motion = push_motion(state, count);
  motion->object = object_number(*bindings.catalog, object);
  motion->duration_s = duration_s;
  motion->asked_ns = bindings.now_ns;
  if (bindings.motion_count == bindings.motions.size()) return nullptr;
  return motion;
}

int finish_motion(lua_State* state, Motion* motion) {
  Bindings& bindings = bindings_of(state);
  if (bindings.recording) return lua_pushboolean(state, 1), 1;  // it begins when the condition is true
  bindings.motions[bindings.motion_count++] = motion;
  return 1;
}

// With limits: as long as the joint takes that needs longest.
double trapezoid_duration_s(const MotionOptions& options, const MotionTargets& targets) {
  if (options.timed) return options.time_s;
  double longest_s = 0;
  for (const MotionTarget& target : targets) {
    const MotionProfile profile =
        SetpointMotions::profile(target.from, target.value, options.velocity_max, options.acceleration_max, 0);
    longest_s = std::max(longest_s, profile.remaining_s());
  }
  return longest_s;
}

double duration_of(const MotionOptions& options, const MotionTargets& targets) {
  return options.trapezoid ? trapezoid_duration_s(options, targets) : options.time_s;
}

// For people.
double rounded(double value) noexcept { return value > 0 ? 0.01 * std::ceil(100 * value - 1e-6) : 0; }

Command trapezoid(const MotionOptions& options, const MotionTarget& target, double duration_s) {
  Command command{.kind = CommandKind::trapezoid, .index = target.id, .value = target.value, .duration_s = duration_s};
  command.velocity = options.velocity_max;
  command.acceleration = options.acceleration_max;
  if (!options.timed) return command;
  const double speed = std::abs(target.from.velocity);
  const double way = std::abs(target.value - target.from.value) + speed * duration_s;
  command.velocity = std::max(least, peak_per_mean * way / duration_s);
  command.acceleration = std::max(least, acceleration_per_way * way / (duration_s * duration_s));
  return command;
}

Command minimum_jerk(const MotionOptions& options, const MotionTarget& target) {
  return {.kind = CommandKind::set_point, .index = target.id, .value = target.value, .duration_s = options.time_s};
}

int send_motion(lua_State* state, const ObjectInfo& object, const MotionOptions& options,
                const MotionTargets& targets) {
  const double duration_s = duration_of(options, targets);
  Motion* motion = start_motion(state, object, targets.count, duration_s);
  for (std::uint32_t i = 0; i < targets.count; ++i) {
    const MotionTarget& target = targets.all[i];
    const Command command = options.trapezoid ? trapezoid(options, target, duration_s) : minimum_jerk(options, target);
    if (!bindings_of(state).send(command)) return queue_full(state);
    if (motion != nullptr) motion->setpoints()[i] = target.id;
  }
  return motion != nullptr ? finish_motion(state, motion) : queue_full(state);
}

// What it takes to read a pose, to check it and to send it: each joint looks for its set-point.
void charge_pose(lua_State* state, const ObjectInfo& object) {
  constexpr double pose_instructions = 400, look_instructions = 4;
  const auto looks = static_cast<double>(object.joints.size() * object.setpoints.size());
  core_of(state).budget.charge(state, pose_instructions + look_instructions * looks);
}

// [-0 +4] nil, a word, a number, and more words.
int push_miss(lua_State* state, const ObjectInfo& object, const Foresight::Miss& miss) {
  using Why = Foresight::Why;
  const Catalog& catalog = *bindings_of(state).catalog;
  const char* const word = miss.why == Why::reach   ? "out_of_reach"
                           : miss.why == Why::bear  ? "cannot_stand"
                           : miss.why == Why::clash ? "in_the_way"
                           : miss.why == Why::tilt  ? "too_tilted"
                           : miss.why == Why::jump  ? "no_smooth_way"
                                                    : "too_quick";
  const auto joint = [&](std::size_t i) {
    return catalog.model != nullptr ? catalog.model->joints[i].name.c_str() : "a joint";
  };
  const auto link = [&](std::size_t i) {
    return catalog.model != nullptr ? catalog.model->links[i].name.c_str() : "a link";
  };
  lua_pushnil(state);
  lua_pushstring(state, word);
  lua_pushnumber(state, miss.by);
  if (miss.why == Why::topple)
    lua_pushfstring(state, "it topples after %f s: give it at least %f s", rounded(miss.after_s), rounded(miss.by));
  if (miss.why == Why::speed)
    lua_pushfstring(state, "%s would be too fast: give it at least %f s", joint(miss.joint), rounded(miss.by));
  if (miss.why == Why::tilt) lua_pushfstring(state, "the trunk would lean by %f rad", rounded(miss.by));
  if (miss.why == Why::jump) lua_pushfstring(state, "%s would jump on the way", joint(miss.joint));
  if (miss.why == Why::clash) lua_pushfstring(state, "%s would hit %s", link(miss.link), link(miss.other));
  if (miss.why == Why::bear)
    lua_pushfstring(state, "it cannot stand on one foot: %s has no motor, and its spring lacks %d Nm/rad",
                    joint(miss.joint), static_cast<int>(std::lround(miss.by)));
  if (miss.why != Why::reach) return 4;
  for (const SetpointId id : object.setpoints) {
    const Setpoint& setpoint = catalog.setpoints[id];
    if (setpoint.channel == miss.channel) return lua_pushstring(state, short_name(object, setpoint.name)), 4;
  }
  return lua_pushnil(state), 4;
}

// [-0 +0..4] 0: the object can reach the targets in their time, as far as it knows. Else nil and
//   "out_of_reach", how far it is from there, and the set-point that it misses most;
//   "too_quick", the least time in s, and a sentence;
//   "in_the_way", the share of the way that is clear, and a sentence with the links that would hit each other;
//   "too_tilted", how far the trunk would lean, and a sentence with it;
//   "no_smooth_way", the share of the way that is smooth, and a sentence with the joint that would jump;
//   "cannot_stand", the stiffness in Nm/rad that is missing, and a sentence.
int foresee(lua_State* state, const ObjectInfo& object, const MotionTargets& targets, const TaskOptions& tasks,
            double time_s) {
  constexpr double foresight_instructions = 10000;
  Bindings& bindings = bindings_of(state);
  if (object.foresight == nullptr || bindings.recording) return 0;
  core_of(state).budget.charge(state, foresight_instructions);
  std::array<Foresight::Goal, max_joints + TaskOptions::commands_max> goals{};
  std::size_t count = 0;
  const auto add = [&](SetpointId id, double value) {
    goals[count++] = {bindings.catalog->setpoints[id].channel, value};
  };
  for (const MotionTarget& target : targets) add(target.id, target.value);
  for (std::uint32_t i = 0; i < tasks.count; ++i) {
    if (tasks.commands[i].kind == CommandKind::set_point) add(tasks.commands[i].index, tasks.commands[i].value);
  }
  const Foresight::Miss miss = object.foresight->miss({{goals.data(), count}, time_s}, *bindings.snapshot);
  return miss.why == Foresight::Why::none ? 0 : push_miss(state, object, miss);
}

// object:move(pose, { time_s = }) -> motion | nil, "queue_full" | nil, why, number, words (foresee). The pose is a
// name, a table joint = rad, or a table of tasks (task_targets.h).
int move(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  const MotionOptions options = read_motion_options(state, 3, MotionOption::move, "move", "rad");
  if (options.relative && lua_type(state, 2) == LUA_TSTRING)
    return luaL_error(state, "move: relative = true needs a table joint = offset, not the pose '%s'",
                      lua_tostring(state, 2));
  charge_pose(state, object);
  MotionTargets targets;
  read_pose(state, 2, object, "move", targets);
  place_targets(state, options, options.trapezoid, targets);
  TaskOptions tasks;
  read_task_options(state, 3, object, targets, tasks);
  if (const int told = foresee(state, object, targets, tasks, duration_of(options, targets)); told > 0) return told;
  for (std::uint32_t i = 0; i < tasks.count; ++i) {
    if (!bindings_of(state).send(tasks.commands[i])) return queue_full(state);
  }
  return send_motion(state, object, options, targets);
}

// object:set(setpoint, value [, { time_s = }]) -> motion | nil, "queue_full" | nil, why, number, words, as move.
int set(lua_State* state) {
  constexpr double set_instructions = 40;
  core_of(state).budget.charge(state, set_instructions);
  const ObjectInfo& object = check_object(state);
  const SetpointId id = read_setpoint(state, 2, object);
  const double value = luaL_checknumber(state, 3);
  const char* unit = bindings_of(state).catalog->setpoints[id].unit.c_str();
  const MotionOptions options = read_motion_options(state, 4, MotionOption::set, "set", unit);
  MotionTargets targets;
  targets.add(id, value);
  place_targets(state, options, options.trapezoid, targets);
  if (const int told = foresee(state, object, targets, {}, duration_of(options, targets)); told > 0) return told;
  return send_motion(state, object, options, targets);
}

// object:follow(pose, { velocity_max_rad_s =, acceleration_max_rad_s2 = }) -> true | nil, "queue_full". Without a
// handle, so that it may be called in every tick.
int follow(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  const MotionOptions options = read_motion_options(state, 3, MotionOption::follow, "follow", "rad");
  charge_pose(state, object);
  MotionTargets targets;
  read_pose(state, 2, object, "follow", targets);
  place_targets(state, options, true, targets);
  for (const MotionTarget& target : targets) {
    if (!bindings_of(state).send(trapezoid(options, target, 0))) return queue_full(state);
  }
  return tell_sent(state, true);
}

// The curves of a motion through points, one a joint.
struct Curves {
  struct Joint {
    SetpointId id = 0;
    double last_s = 0;  // time of its last point
    CubicSpline spline;
  };
  std::array<Joint, max_joints> joints;
  std::uint32_t count = 0;
};

Curves::Joint& curve_of(Curves& curves, const MotionTarget& target) {
  for (std::uint32_t i = 0; i < curves.count; ++i) {
    if (curves.joints[i].id == target.id) return curves.joints[i];
  }
  Curves::Joint& fresh = curves.joints[curves.count++];
  fresh.id = target.id;
  fresh.spline.begin(target.from.value, target.from.velocity);
  return fresh;
}

// The point { pose, time_s = } at the top of the stack, time_s after the one before: its targets, and how long.
double read_point(lua_State* state, int number, const ObjectInfo& object, const MotionOptions& options,
                  MotionTargets& targets) {
  const int point = lua_gettop(state);
  if (!lua_istable(state, point))
    luaL_error(state, "move_through: point %d must be { pose, time_s = seconds }, not a %s", number,
               luaL_typename(state, point));
  const MotionOptions timing = read_motion_options(state, point, MotionOption::point, "a point of move_through", "rad");
  if (!(timing.time_s > 0)) luaL_error(state, "move_through: point %d needs time_s > 0", number);
  lua_rawgeti(state, point, 1);
  if (options.relative && lua_type(state, -1) == LUA_TSTRING)
    luaL_error(state, "move_through: relative = true needs tables joint = offset, not the pose '%s'",
               lua_tostring(state, -1));
  read_pose(state, lua_gettop(state), object, "a point of move_through", targets);
  place_targets(state, options, true, targets);
  lua_settop(state, point);
  return timing.time_s;
}

double read_points(lua_State* state, const ObjectInfo& object, const MotionOptions& options, Curves& curves) {
  if (!lua_istable(state, 2)) luaL_error(state, "move_through needs a list { { pose, time_s = seconds }, ... }");
  const auto count = static_cast<int>(lua_objlen(state, 2));
  if (count < 1 || count > static_cast<int>(CubicSpline::points_max))
    luaL_error(state, "move_through takes 1..%d points, not %d", static_cast<int>(CubicSpline::points_max), count);
  double time_s = 0;
  MotionTargets targets;
  for (int i = 1; i <= count; ++i) {
    lua_rawgeti(state, 2, i);
    charge_pose(state, object);
    time_s += read_point(state, i, object, options, targets);
    lua_pop(state, 1);
    for (const MotionTarget& target : targets) {
      Curves::Joint& curve = curve_of(curves, target);
      (void)curve.spline.add(target.value, time_s - curve.last_s);
      curve.last_s = time_s;
    }
  }
  return time_s;
}

// A curve swings beyond its points: not beyond the joint's range.
void check_curves(lua_State* state, Curves& curves) {
  const Catalog& catalog = *bindings_of(state).catalog;
  for (std::uint32_t i = 0; i < curves.count; ++i) {
    const Setpoint& setpoint = catalog.setpoints[curves.joints[i].id];
    curves.joints[i].spline.plan();
    const CubicSpline::Range range = curves.joints[i].spline.range();
    constexpr double rounding = 1e-9;
    if (range.lowest >= setpoint.min - rounding && range.highest <= setpoint.max + rounding) continue;
    luaL_error(state, "move_through: between the points %s swings to %f, outside its range %f..%f %s",
               setpoint.name.c_str(), range.lowest < setpoint.min ? range.lowest : range.highest, setpoint.min,
               setpoint.max, setpoint.unit.c_str());
  }
}

// object:move_through({ { pose, time_s = }, ... } [, { relative = true }]) -> motion | nil, "queue_full". A curve with
// continuous velocity and acceleration through the points, each time_s after the one before; to rest at the last one.
int move_through(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  const MotionOptions options = read_motion_options(state, 3, MotionOption::through, "move_through", "rad");
  lua_settop(state, 3);
  Curves curves;
  const double duration_s = read_points(state, object, options, curves);
  check_curves(state, curves);
  Motion* motion = start_motion(state, object, curves.count, duration_s);
  for (std::uint32_t i = 0; i < curves.count; ++i) {
    const Curves::Joint& curve = curves.joints[i];
    for (std::uint32_t via = 0; via < curve.spline.size(); ++via) {
      const CubicSpline::Point point = curve.spline.point(via);
      if (!bindings_of(state).send({.kind = CommandKind::via_point,
                                    .index = curve.id,
                                    .count = via,
                                    .value = point.value,
                                    .duration_s = point.duration_s}))
        return queue_full(state);
    }
    if (motion != nullptr) motion->setpoints()[i] = curve.id;
  }
  return motion != nullptr ? finish_motion(state, motion) : queue_full(state);
}

// A table that is given may compute its fields, and so call the method again.
template <lua_CFunction method>
int nested(lua_State* state) {
  begin_callback(state, "a motion");
  const int results = method(state);
  end_callback(state);
  return results;
}

}  // namespace

void open_motion_methods(lua_State* state) {
  const luaL_Reg methods[] = {
      {"move", nested<move>}, {"move_through", nested<move_through>}, {"set", nested<set>}, {"follow", nested<follow>}};
  set_functions(state, methods);
}

}  // namespace kadans

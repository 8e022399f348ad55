// What a method that moves set-points is given: its options and its targets. The bindings and `kadans behavior check`
// read it, and editor stubs and the reference are made from it.
//
//   minimum_jerk  from its present state to rest in time_s; peak 1.875 times the mean speed
//   trapezoid     speeds up, cruises, slows down, as fast as the limits of velocity and acceleration allow; all joints
//                 arrive together. Or in time_s, with a peak of about 1.3 times the mean speed
//   spline        through points at given times (move_through)
//   follow        a trapezoid without an end: the target may change in every tick
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <lua.hpp>

#include "kadans/control/catalog.h"

namespace kadans {

struct MotionOption {
  enum Method : std::uint8_t { move = 1, set = 2, through = 4, point = 8, follow = 16 };
  enum class Type : std::uint8_t { number, text, flag, list };
  const char* name;
  Type type;
  double min, max;     // range of a number
  const char* unit;    // unit of a number
  const char* length;  // of a limit: the unit of the set-points that it is for; nullptr: any
  std::uint8_t methods;
  const char* doc;
};
std::span<const MotionOption> motion_options() noexcept;

struct MotionMethod {
  const char* name;
  MotionOption::Method kind;
  const char* needs;  // how a message names the missing last argument; nullptr: it is optional
};
std::span<const MotionMethod> motion_methods() noexcept;

inline constexpr const char* motion_profiles[] = {"minimum_jerk", "trapezoid"};

struct MotionOptions {
  bool trapezoid = false;
  bool relative = false;  // values are offsets from the present set-points
  bool timed = false;     // time_s was given
  double time_s = 0;
  double velocity_max = 0, acceleration_max = 0;  // 0: not given
  const char* velocity_name = "";                 // the option's name as given
};

// Reads the table at `index`. `called` is the method's name in messages, `unit` the unit of the moved set-points.
// Raises on an option that is unknown, of the wrong type, out of its range or missing, and on options that do not fit
// together.
MotionOptions read_motion_options(lua_State* state, int index, MotionOption::Method method, const char* called,
                                  const char* unit);

// The set-points that a motion moves and their targets, read from a pose by name, a table joint = position, or one
// set-point. All functions raise at the author's line and send nothing.
struct MotionTarget {
  SetpointId id = 0;
  double value = 0;
  SetpointState from;  // the present set-point; set by place_targets
};

struct MotionTargets {
  std::array<MotionTarget, max_joints> all;
  std::uint32_t count = 0;
  void add(SetpointId id, double value) noexcept { all[count++] = {.id = id, .value = value, .from = {}}; }
  const MotionTarget* begin() const noexcept { return all.data(); }
  const MotionTarget* end() const noexcept { return all.data() + count; }
};

// Reads the pose at `index`: its name, or a table joint = rad. `called` is the method's name for messages.
void read_pose(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets);
// The set-point that is named at `index`.
SetpointId read_setpoint(lua_State* state, int index, const ObjectInfo& object);

// The present set-point from the snapshot, or the position of its joint when its object is not active yet. Raises when
// the control object does not report it.
SetpointState present_setpoint(lua_State* state, SetpointId id);
// Adds offsets, checks ranges, and finds the start of the motion if it is needed.
void place_targets(lua_State* state, const MotionOptions& options, bool planned, MotionTargets& targets);

}  // namespace kadans

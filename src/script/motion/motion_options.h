// The table of a motion's options. The bindings and `kadans behavior check` read it, and editor stubs and the reference
// are made from it.
//
//   minimum_jerk  the control object's own: from its present state to rest in time_s; peak 1.875 times the mean speed
//   trapezoid     speeds up, cruises, slows down, as fast as the limits of velocity and acceleration allow; all joints
//                 arrive together. Or in time_s, with a peak of about 1.3 times the mean speed
//   spline        through points at given times (move_through)
//   follow        a trapezoid without an end: the target may change in every tick
#pragma once

#include <cstdint>
#include <span>

#include <lua.hpp>

namespace kadans {

struct MotionOption {
  enum Method : std::uint8_t { move = 1, set = 2, through = 4, point = 8, follow = 16 };
  enum class Type : std::uint8_t { number, text, flag };
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

}  // namespace kadans

// How a motion is asked for: the table of its options, which the bindings read, `kadans behavior check` looks up and
// editor stubs and reference are made from.
//
//   minimum_jerk  the control object's own: from the state it has to rest in time_s, peak 1.875 times the mean speed
//   trapezoid     speeds up, cruises, slows down: as fast as limits of velocity and acceleration allow, all joints
//                 arriving together; or in time_s, with a peak of about 1.3 times the mean speed
//   spline        through points at given times (move_through)
//   follow        a trapezoid without an end: the target may be another in every tick
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
  double min, max;     // of a number
  const char* unit;    // of a number
  const char* length;  // the unit of what it moves, of a limit; nullptr: any
  std::uint8_t methods;
  const char* doc;
};
std::span<const MotionOption> motion_options() noexcept;

struct MotionMethod {
  const char* name;
  MotionOption::Method kind;
  const char* needs;  // how a message says that the last argument is missing; nullptr: it need not be there
};
std::span<const MotionMethod> motion_methods() noexcept;

inline constexpr const char* motion_profiles[] = {"minimum_jerk", "trapezoid"};

struct MotionOptions {
  bool trapezoid = false;
  bool relative = false;  // values are offsets to where the set-points are
  bool timed = false;     // time_s was given
  double time_s = 0;
  double velocity_max = 0, acceleration_max = 0;  // 0: not given
  const char* velocity_name = "";                 // as given
};

// Reads the table at `index`; `called` is what messages call the method, `unit` what it moves. Raises at whatever is
// unknown, of the wrong type, out of its range, missing, or does not fit together.
MotionOptions read_motion_options(lua_State* state, int index, MotionOption::Method method, const char* called,
                                  const char* unit);

}  // namespace kadans

#include "motion_options.h"

#include <array>
#include <cmath>
#include <cstring>

#include "script/check/hint.h"
#include "script/lua/script_error.h"

namespace kadans {
namespace {

using Type = MotionOption::Type;

constexpr std::uint8_t move_set = MotionOption::move | MotionOption::set;
constexpr std::uint8_t limited = move_set | MotionOption::follow;
constexpr double limit_min = 0.001, velocity_most = 1000, acceleration_most = 10000;
constexpr MotionOption table[] = {
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
  std::array<const char*, std::size(table) + 1> names{};
  std::size_t count = 0;
  for (const MotionOption& option : table) {
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
    case Type::number:
      break;
  }
  const double value = check_number(state, option, called, unit);
  if (starts_with(option.name, "time")) {
    options.timed = true;
    options.time_s = value;
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

std::span<const MotionOption> motion_options() noexcept { return table; }
std::span<const MotionMethod> motion_methods() noexcept { return methods; }

MotionOptions read_motion_options(lua_State* state, int index, MotionOption::Method method, const char* called,
                                  const char* unit) {
  MotionOptions options;
  if (lua_isnoneornil(state, index) && (method == MotionOption::set || method == MotionOption::through)) return options;
  if (lua_istable(state, index)) {
    check_names(state, index, method, called);
    for (const MotionOption& option : table) {
      lua_getfield(state, index, option.name);
      if (!lua_isnil(state, -1)) take(state, option, called, unit, options);
      lua_pop(state, 1);
    }
  } else if (method == MotionOption::set || method == MotionOption::through) {
    luaL_error(state, "%s: the last argument must be a table { ... }, not a %s", called, luaL_typename(state, index));
  }
  if (method != MotionOption::through && method != MotionOption::point) check_together(state, method, called, options);
  return options;
}

}  // namespace kadans

// Makes the hint of a message, ", did you mean 'x'?". No C++ object is alive when Lua raises.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/nearest_name.h"
#include "script/lua/lua_core.h"
#include "signal/number_text.h"

namespace kadans {

using Hint = std::array<char, 320>;

// The nearest name, or a name that begins with it (a forgotten unit), or else all names when they are few.
inline std::string hint_text(const std::string& wrong, const std::vector<std::string>& names) {
  std::string near = did_you_mean(wrong, names);
  if (!near.empty() || names.empty()) return near;
  for (const std::string& name : names) {
    const bool begins = name.size() >= 4 && wrong.starts_with(name + "_");  // move_to
    if (begins || (wrong.size() >= 3 && name.starts_with(wrong))) return ", did you mean '" + name + "'?";
  }
  return names.empty() || names.size() > 8 ? "" : "; there is: " + listed(names);
}

// For a number that is outside its range in rad, but inside it when it was meant in degrees.
inline std::array<char, 64> degree_hint(std::string_view unit, double value, double min, double max) {
  constexpr double degree_rad = 3.14159265358979323846 / 180;
  std::array<char, 64> text{};
  const double turned = value * degree_rad;
  if (unit == "rad" && turned >= min && turned <= max)
    std::snprintf(text.data(), text.size(), "; %.14g degrees are %.3f rad", value, turned);
  return text;
}

// `fill` adds the known names to the vector that it gets; it must not raise. The time is proportional to the product of
// the lengths. It is charged at the end, when no object that needs a destructor is left.
template <typename Fill>
Hint make_hint(lua_State* state, const char* wrong, Fill fill) {
  constexpr double instructions_per_letter = 2;
  Hint hint{};
  double letters = 100;
  {
    std::vector<std::string> names;
    fill(names);
    std::sort(names.begin(), names.end());
    const std::string text = wrong;
    for (const std::string& name : names)
      letters += static_cast<double>((name.size() + 8) * (std::min(text.size(), nearest_name_longest) + 8));
    std::snprintf(hint.data(), hint.size(), "%s", hint_text(text, names).c_str());
  }
  core_of(state).budget.charge(state, instructions_per_letter * letters);
  return hint;
}

// The one of this name. Raises: "unknown pose 'x', did you mean 'y'?".
template <typename Named>
const Named& check_named(lua_State* state, const std::vector<Named>& all, const char* name, const char* kind) {
  const auto found = std::ranges::find(all, name, &Named::name);
  if (found != all.end()) return *found;
  const Hint hint = make_hint(state, name, [&](auto& names) { names = names_of(all); });
  luaL_error(state, "unknown %s '%s'%s", kind, name, hint.data());
  __builtin_unreachable();  // luaL_error does not return
}

}  // namespace kadans

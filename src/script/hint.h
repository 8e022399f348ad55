// The hint of a message, ", did you mean 'x'?", made without leaving a C++ object behind when Lua raises.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "kadans/signal/nearest_name.h"

namespace kadans {

using Hint = std::array<char, 320>;

// What is near, or begins like it (a unit forgotten), or else all names when they are few.
inline std::string hint_text(const std::string& wrong, const std::vector<std::string>& names) {
  std::string near = did_you_mean(wrong, names);
  if (!near.empty() || names.empty()) return near;
  for (const std::string& name : names) {
    if (wrong.size() >= 3 && name.starts_with(wrong)) return ", did you mean '" + name + "'?";
  }
  if (names.size() > 8) return "";
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "; there is: " : ", ") + name;
  return all;
}

// `fill` adds the known names to the vector it is given.
template <typename Fill>
Hint make_hint(const char* wrong, Fill fill) {
  std::vector<std::string> names;
  fill(names);
  std::sort(names.begin(), names.end());
  Hint hint{};
  std::snprintf(hint.data(), hint.size(), "%s", hint_text(wrong, names).c_str());
  return hint;
}

}  // namespace kadans

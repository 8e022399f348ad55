// The hint of a message, ", did you mean 'x'?", made without leaving a C++ object behind when Lua raises.
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "kadans/signal/nearest_name.h"

namespace kadans {

using Hint = std::array<char, 160>;

// `fill` adds the known names to the vector it is given.
template <typename Fill>
Hint make_hint(const char* wrong, Fill fill) {
  std::vector<std::string> names;
  fill(names);
  std::sort(names.begin(), names.end());
  Hint hint{};
  std::snprintf(hint.data(), hint.size(), "%s", did_you_mean(wrong, names).c_str());
  return hint;
}

}  // namespace kadans

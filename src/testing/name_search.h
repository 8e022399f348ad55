// Finds a name by its last parts: "kp_Nm_per_rad" for "object.joint.kp_Nm_per_rad".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kadans::testing {

// The number of the one name that is `wanted` or ends in "." + wanted, and begins with `prefix`. Throws
// std::invalid_argument when there is none, with the nearest, or more than one.
std::size_t find_by_ending(std::string_view what, std::string_view wanted, const std::vector<std::string>& names,
                           std::string_view prefix = "");

}  // namespace kadans::testing

// Checks of options that are numbers. CLI11's own checks accept nan, and read -1 as 18446744073709551615.
#pragma once

#include <cstdint>
#include <limits>

#include <CLI/CLI.hpp>

namespace kadans {

// Accepts a finite number from min to max.
CLI::Validator number_within(double min, double max);
inline CLI::Validator any_number() {
  return number_within(std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max());
}

// Accepts a whole number from min to max: digits only, and a sign when min is below 0.
CLI::Validator whole_within(std::int64_t min, std::uint64_t max);
inline CLI::Validator any_seed() { return whole_within(0, std::numeric_limits<std::uint64_t>::max()); }

}  // namespace kadans

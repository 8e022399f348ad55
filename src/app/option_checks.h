// Checks of options that are numbers. CLI11's own let nan pass, and read -1 as 18446744073709551615.
#pragma once

#include <cstdint>
#include <limits>

#include <CLI/CLI.hpp>

namespace kadans {

// A finite number from min to max.
CLI::Validator number_within(double min, double max);
inline CLI::Validator any_number() {
  return number_within(std::numeric_limits<double>::lowest(), std::numeric_limits<double>::max());
}

// Digits alone, from min to max; from below 0 a sign too.
CLI::Validator whole_within(std::int64_t min, std::uint64_t max);
inline CLI::Validator any_seed() { return whole_within(0, std::numeric_limits<std::uint64_t>::max()); }

}  // namespace kadans

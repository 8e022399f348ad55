// Options that are numbers, and their checks. CLI11's own checks accept nan, and read -1 as 18446744073709551615.
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

// The option with its check. `unit` stands behind its name in the help.
template <typename Place>
CLI::Option* add_number(CLI::App& command, const char* name, Place& place, double min, double max, const char* unit,
                        const char* doc) {
  return command.add_option(name, place, doc)->type_name(unit)->check(number_within(min, max));
}
template <typename Place>
CLI::Option* add_whole(CLI::App& command, const char* name, Place& place, std::int64_t min, std::uint64_t max,
                       const char* doc) {
  return command.add_option(name, place, doc)->type_name("N")->check(whole_within(min, max));
}
template <typename Place>
CLI::Option* add_seed(CLI::App& command, Place& place, const char* doc) {
  return add_whole(command, "--seed", place, 0, std::numeric_limits<std::uint64_t>::max(), doc);
}
inline void add_jobs(CLI::App& command, unsigned& jobs) {
  add_whole(command, "-j,--jobs", jobs, 1, 1024, "Runs at the same time (default: one a core)");
}

}  // namespace kadans

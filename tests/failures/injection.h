// One fault, drawn at random, put into a run of the light robot, and what must come of it.
#pragma once

#include <cstdint>
#include <string>

namespace kadans::failures {

enum class Category : std::uint8_t { sensor, command, actuation, timing, script };

struct Outcome {
  std::string injected;  // "stuck joint 2 at tick 143"
  std::string problem;   // what promise was broken; "" when all were kept
};

// The same seed injects the same fault into the same run.
Outcome inject(Category category, std::uint64_t seed);

}  // namespace kadans::failures

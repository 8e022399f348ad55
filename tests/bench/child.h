// A program run to its end, and what it took.
#pragma once

#include <string>
#include <vector>

namespace kadans::bench {

struct Usage {
  double wall_ms = 0;      // start to exit
  double resident_mb = 0;  // at most
};

// All at once, each with these arguments, their output thrown away; of all: the time until the last has ended, the
// largest memory. Throws std::runtime_error when one cannot be started or fails.
Usage run_children(const std::vector<std::string>& command, int count = 1);

}  // namespace kadans::bench

// What the control ticks of a run took between two moments, from what its live server tells on /timing: how many were
// at most so late, for a row of limits that stays the same.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/live/web_socket.h"

namespace kadans::bench {

struct Distribution {
  double count = 0;
  std::vector<double> limits_us, within;

  Distribution since(const Distribution& before) const;
  double percentile_us(double share) const;  // between two limits in proportion
};

struct TickTimes {
  Distribution late, takes;
};

// Connects, reads, leaves within a second: its own client is none of those that are measured.
TickTimes tick_times(std::uint16_t port);

}  // namespace kadans::bench

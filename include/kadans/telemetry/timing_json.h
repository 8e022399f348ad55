// Histograms of what ticks and tasks cost, as viewers read them on /timing.
#pragma once

#include <string>
#include <vector>

#include "kadans/engine/tick_statistics.h"

namespace kadans {

struct TimingSource {
  std::string name;
  const TickStatistics* statistics;
};

// {"control tick": {"unit", "low", "high", "counts", "median", "p99", "max", "count"}}, in microseconds. Any thread.
std::string timing_json(const std::vector<TimingSource>& sources);
inline constexpr const char* timing_schema = R"({"title": "kadans.Timing", "type": "object"})";

}  // namespace kadans

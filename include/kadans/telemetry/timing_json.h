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

// {"control tick": {"unit", "low", "high", "counts", "median", "p99", "max", "count", "limits", "within"}}, in
// microseconds. `within` says how many were at most as long as each of `limits`, always the same ones: the differences
// between two messages are the histogram of what was between them. Any thread.
std::string timing_json(const std::vector<TimingSource>& sources);
inline constexpr const char* timing_schema = R"({"title": "kadans.Timing", "type": "object"})";

}  // namespace kadans

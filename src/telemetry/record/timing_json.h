// Histograms of the durations of ticks and tasks, which viewers read on /timing.
#pragma once

#include <string>
#include <vector>

#include "engine/tick/tick_statistics.h"

namespace kadans {

struct TimingSource {
  std::string name;
  const TickStatistics* statistics;
};

// {"control tick": {"unit", "low", "high", "counts", "median", "p99", "max", "count", "limits", "within"}}, in
// microseconds. `within` counts the durations up to each of `limits`, which never change. So the difference between two
// messages is the histogram of the time between them. Any thread.
std::string timing_json(const std::vector<TimingSource>& sources);
inline constexpr const char* timing_schema = R"({"title": "kadans.Timing", "type": "object"})";

}  // namespace kadans

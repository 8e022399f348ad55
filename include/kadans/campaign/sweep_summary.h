// What a sweep says: for people as text, for machines as one object.
#pragma once

#include <string>

#include "kadans/campaign/merged_sweep.h"

namespace kadans {

struct SweepCounts {
  std::size_t cases = 0;  // with a result
  std::size_t passed = 0;
  std::size_t first_try = 0;  // passed, and the metric that says so is not 0
  double median_s = 0;        // of the time metric over the runs that passed; NaN without one
};
SweepCounts counts(const MergedSweep& sweep);

// Complete, and as many passed as the plan demands.
bool passed(const MergedSweep& sweep);

// Shares with their intervals, metrics, the checks that failed, the worst cases with the line that repeats each, what
// is missing. The same for the same rows.
std::string sweep_summary(const MergedSweep& sweep);

// {sweep, cases, passed, first_try, median_s}, one line; null for what the plan does not measure.
std::string sweep_json(const MergedSweep& sweep);

}  // namespace kadans

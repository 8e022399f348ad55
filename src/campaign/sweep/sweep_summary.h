// The summary of a sweep: as text for people, as one JSON object for machines.
#pragma once

#include <string>

#include "merged_sweep.h"

namespace kadans {

struct SweepCounts {
  std::size_t cases = 0;  // with a result
  std::size_t passed = 0;
  std::size_t first_try = 0;  // runs that passed and whose first_try metric is not 0
  double median_s = 0;        // median of the time metric over the runs that passed; NaN without one
};
SweepCounts counts(const MergedSweep& sweep);

// True when no case is missing and the share that passed is at least passed_min.
bool passed(const MergedSweep& sweep);

// Shares with their intervals, metrics, the checks that failed, the worst cases with the command that repeats each, and
// the missing cases. The same rows give the same text.
std::string sweep_summary(const MergedSweep& sweep);

// {sweep, cases, passed, first_try, median_s} on one line; null for a value that the plan does not measure.
std::string sweep_json(const MergedSweep& sweep);

}  // namespace kadans

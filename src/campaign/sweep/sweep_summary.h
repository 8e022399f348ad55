// The results of a sweep for those who read them: a summary as text and as one JSON object, and a picture.
#pragma once

#include <string>

#include "merged_sweep.h"

namespace kadans {

// The summary of a sweep: as text for people, as one JSON object for machines.
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

// The results of a sweep over two quantities, as a picture.
struct HeatMapOptions {
  std::string x, y;    // quantities
  std::string metric;  // "": the share that passed
};

// An SVG document. A quantity with few values has a column or row for each value; any other has ten of equal width.
// Each field shows the mean or the share as a number and as a colour, and how many cases it covers. Throws InputError
// for an unknown name.
std::string heat_map_svg(const MergedSweep& sweep, const HeatMapOptions& options);

}  // namespace kadans

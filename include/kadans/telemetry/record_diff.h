// Where two records part: every signal that both have, at every time at which one of them has a row; then transitions,
// faults and log lines, and what else they hold. A signal holds its value from one row to the next; one that is
// recorded more slowly is compared in the ticks of its rate. Two numbers are the same as replay has it
// (record_comparison.h): -0 is 0, every NaN is one, single precision where one of the records is; or as far apart as
// the tolerance allows. What viewers read (joint states, transforms) is made of the signals, and not compared again;
// nor is what ticks cost. Both are read along, so their length does not matter.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/telemetry/record_outline.h"

namespace kadans {

struct SignalParting {
  std::string name, unit;
  std::int64_t first_ns = 0;
  double first_a = 0, first_b = 0;
  std::int64_t most_ns = 0;
  double most_a = 0, most_b = 0;
  double most = 0;  // greatest difference; infinite where only one is a number
  std::uint64_t rows = 0;
};

struct RecordDiff {
  std::uint64_t rows = 0;                             // compared
  std::size_t signals = 0;                            // that both have and that are compared
  std::vector<SignalParting> partings;                // by when they first part, then in the order of the first record
  std::vector<std::string> only_a, only_b;            // signals
  std::uint64_t rows_only_a = 0, rows_only_b = 0;     // times at which only one has rows
  std::int64_t row_only_a_ns = 0, row_only_b_ns = 0;  // the first of each
  std::vector<std::string> events_only_a, events_only_b;  // "  1.500 s  squat: down -> up"
  std::vector<std::string> other_topics;                  // that hold neither, and differ

  bool same() const noexcept {
    return partings.empty() && only_a.empty() && only_b.empty() && rows_only_a == 0 && rows_only_b == 0 &&
           events_only_a.empty() && events_only_b.empty() && other_topics.empty();
  }
};

RecordDiff diff_records(const RecordOutline& a, const RecordOutline& b, double tolerance);

// What the runs were made of, where it differs: "seed: 1, 2", "libm.so.6".
std::vector<std::string> differing_facts(const RecordOutline& a, const RecordOutline& b);

}  // namespace kadans

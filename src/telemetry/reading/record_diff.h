// The differences between two records: of every signal that both have, at every time at which one of them has a row;
// then of transitions, faults, log lines and other topics. A signal keeps its value from one row to the next. A signal
// with a lower rate is compared only in the ticks of its rate. Numbers are compared as in a replay
// (record_comparison.h): -0 equals 0, all NaN are equal, and single precision is used when one of the records has it.
// Differences up to the tolerance are ignored. Messages for viewers (joint states, transforms) are made from the
// signals and are not compared again, and neither are the costs of ticks. Both records are read row by row, so they may
// have any length.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "record_outline.h"

namespace kadans {

struct SignalParting {
  std::string name, unit;
  std::int64_t first_ns = 0;
  double first_a = 0, first_b = 0;
  std::int64_t most_ns = 0;
  double most_a = 0, most_b = 0;
  double most = 0;  // greatest difference; infinite when one of the values is not finite
  std::uint64_t rows = 0;
};

struct RecordDiff {
  std::uint64_t rows = 0;                   // times at which rows were compared
  std::size_t signals = 0;                  // signals that both have and that are compared
  std::vector<SignalParting> partings;      // by time of the first difference, then in the order of the first record
  std::vector<std::string> only_a, only_b;  // signals
  std::uint64_t rows_only_a = 0, rows_only_b = 0;         // times at which only one record has rows
  std::int64_t row_only_a_ns = 0, row_only_b_ns = 0;      // the first of each
  std::vector<std::string> events_only_a, events_only_b;  // "  1.500 s  squat: down -> up"
  std::vector<std::string> other_topics;                  // topics with neither rows nor events that differ

  bool same() const noexcept {
    return partings.empty() && only_a.empty() && only_b.empty() && rows_only_a == 0 && rows_only_b == 0 &&
           events_only_a.empty() && events_only_b.empty() && other_topics.empty();
  }
};

RecordDiff diff_records(const RecordOutline& a, const RecordOutline& b, double tolerance);

// The inputs of the two runs that differ: "seed: 1, 2", "libm.so.6".
std::vector<std::string> differing_facts(const RecordOutline& a, const RecordOutline& b);

}  // namespace kadans

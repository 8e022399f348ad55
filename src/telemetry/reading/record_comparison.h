// Compares records: a record with a run that should repeat it, and two records with each other.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/signal.h"
#include "record_rows.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/signal_topics.h"

namespace kadans {

// Compares a record with a run that should repeat it: every signal of the record, in every tick, bit for bit. As in the
// state hash, -0 and 0 are one value, and all NaN are one value. A record in single precision is compared in single
// precision.
//
// A topic that stands still has no message in some ticks (record_writer.h); then its last values are compared. The
// record is read while the run goes, so it may have any length. Signals about the interpreter's own needs (memory,
// instructions, pauses of the garbage collector) say nothing of the robot and are not compared.

// True when equal; -0 equals 0, and NaN equals NaN.
inline bool same_value(double a, double b) noexcept { return a == b || (a != a && b != b); }
// True when the signal's name says that it is about the interpreter's own needs.
bool is_upkeep(const std::string& name);

struct SignalDifference {
  std::string name, unit;
  double recorded = 0, replayed = 0;
};

class RecordComparison {
 public:
  // Keeps references. The reader must not have read a message yet.
  RecordComparison(McapReader& record, const SignalTable& signals);

  // Compares one tick of the run; call it for each tick in order. It does nothing once a difference was found or the
  // record has ended.
  void compare(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);
  // Of signals that nobody computes yet: they are compared again when `yes` is false.
  void leave_out(SignalId signal, bool yes) { left_out_[signal] = yes; }

  bool over() const noexcept { return parted_ || ended_; }
  bool parted() const noexcept { return parted_; }
  bool ended() const noexcept { return ended_; }         // the record has no more ticks
  std::uint64_t tick() const noexcept { return tick_; }  // the tick of the first difference
  std::int64_t time_ns() const noexcept { return time_ns_; }
  // The differences in that tick, in the order of the run's signal table.
  const std::vector<SignalDifference>& differences() const noexcept { return differences_; }

  std::uint64_t ticks() const noexcept { return ticks_; }                  // ticks that were compared and equal
  std::size_t signals() const noexcept { return compared_; }               // signals that both have
  const std::vector<std::string>& gone() const noexcept { return gone_; }  // signals that only the record has

 private:
  struct Topic {
    std::vector<SignalId> signals;  // in the order of the message; not_compared
    std::vector<double> values;     // of its last message
    std::uint32_t every_ticks = 1, standstill_ticks = 1;
    bool single = false, read = false;
    std::uint32_t sequence = 0;  // of its last message
  };
  static constexpr SignalId not_compared = 0xffffffff;

  void advance();
  Topic& topic_of(std::uint16_t channel);
  bool compare_message(std::span<const double> row, std::int64_t time_ns);
  bool compare_standing(std::uint64_t tick, std::span<const double> row);
  void compare_values(const Topic& topic, std::span<const double> row);

  McapReader& record_;
  const SignalTable& table_;
  std::map<std::uint16_t, Topic> topics_;
  std::vector<bool> left_out_;  // by signal
  McapMessage message_;
  std::vector<std::pair<SignalId, SignalDifference>> found_;
  std::vector<SignalDifference> differences_;
  std::vector<std::string> gone_;
  std::size_t compared_ = 0;
  bool parted_ = false, ended_ = false;
  std::uint64_t tick_ = 0, ticks_ = 0;
  std::int64_t time_ns_ = 0;
};

// The differences between two records: of every signal that both have, at every time at which one of them has a row;
// then of transitions, faults, log lines and other topics. A signal keeps its value from one row to the next. A signal
// with a lower rate is compared only in the ticks of its rate. Numbers are compared as in a replay:
// -0 equals 0, all NaN are equal, and single precision is used when one of the records has it.
// Differences up to the tolerance are ignored. Messages for viewers (joint states, transforms) are made from the
// signals and are not compared again, and neither are the costs of ticks. Both records are read row by row, so they may
// have any length.
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

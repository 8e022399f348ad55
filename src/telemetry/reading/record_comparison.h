// Compares a record with a run that should repeat it: every signal of the record, in every tick, bit for bit. As in the
// state hash, -0 and 0 are one value, and all NaN are one value. A record in single precision is compared in single
// precision.
//
// A topic that stands still has no message in some ticks (record_writer.h); then its last values are compared. The
// record is read while the run goes, so it may have any length. Signals about the interpreter's own needs (memory,
// instructions, pauses of the garbage collector) say nothing of the robot and are not compared.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/signal.h"
#include "telemetry/mcap/mcap_reader.h"
#include "telemetry/record/signal_topics.h"

namespace kadans {

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
  McapMessage message_;
  std::vector<std::pair<SignalId, SignalDifference>> found_;
  std::vector<SignalDifference> differences_;
  std::vector<std::string> gone_;
  std::size_t compared_ = 0;
  bool parted_ = false, ended_ = false;
  std::uint64_t tick_ = 0, ticks_ = 0;
  std::int64_t time_ns_ = 0;
};

}  // namespace kadans

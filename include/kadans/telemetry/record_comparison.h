// A record against a run that should repeat it: every signal that the record holds, in every tick, bit for bit. As for
// the state hash, -0 and 0 are one value, and so is every NaN; a record in single precision is compared in that.
//
// A topic that stood still has no message each tick (record_writer.h): what it held before is compared then. The record
// is read along as the run goes, so its length does not matter. What the interpreter needs for a behavior
// (memory, instructions, pauses of its collector) is not the robot's, and is not compared.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/signal.h"
#include "kadans/telemetry/mcap_reader.h"
#include "kadans/telemetry/signal_topics.h"

namespace kadans {

// -0 and 0 are equal, and so are all NaN.
inline bool same_value(double a, double b) noexcept { return a == b || (a != a && b != b); }
// What the interpreter needs, by the signal's name.
bool is_upkeep(const std::string& name);

struct SignalDifference {
  std::string name, unit;
  double recorded = 0, replayed = 0;
};

class RecordComparison {
 public:
  // Keeps references; the reader stands at the first message or before.
  RecordComparison(McapReader& record, const SignalTable& signals);

  // One tick of the run, in order. Does nothing once they have parted or the record is over.
  void compare(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row);

  bool over() const noexcept { return parted_ || ended_; }
  bool parted() const noexcept { return parted_; }
  bool ended() const noexcept { return ended_; }         // the record has no more ticks
  std::uint64_t tick() const noexcept { return tick_; }  // where they parted
  std::int64_t time_ns() const noexcept { return time_ns_; }
  // Of that tick, in the order of the run's signal table.
  const std::vector<SignalDifference>& differences() const noexcept { return differences_; }

  std::uint64_t ticks() const noexcept { return ticks_; }                  // compared and the same
  std::size_t signals() const noexcept { return compared_; }               // that both have
  const std::vector<std::string>& gone() const noexcept { return gone_; }  // the record has, the run has not

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

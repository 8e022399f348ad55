// Repeats the decisions of a run on threads from what its record holds of them (channel /inputs/decisions): each of
// their ticks gets what it got, and what they ask for is compared. What plays does not hear them: it gets the orders
// that were recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/behavior_inputs.h"
#include "kadans/signal/status.h"
#include "script/host/play_report.h"
#include "supervisor/decide/supervisor.h"
#include "telemetry/reading/input_reader.h"

namespace kadans {

class RepeatedDecisions final : private BehaviorInputs {
 public:
  // Of a supervisor whose decisions run here. It must outlive this object, and tells it what its scripts take.
  // `write_file` gets the files that were read in a tick, before that is repeated.
  RepeatedDecisions(const std::string& record, Supervisor& supervisor,
                    std::function<void(const BehaviorInput&)> write_file);
  ~RepeatedDecisions() override { supervisor_.take_inputs_by(nullptr); }

  // All ticks that saw this snapshot, or one before. To be called between two control ticks.
  void repeat(const Snapshot& newest);

  std::uint64_t ticks() const noexcept { return ticks_; }
  // What they decide otherwise than recorded, and when; "": nothing. Nothing is repeated after it.
  const std::string& parting() const noexcept { return parting_; }
  bool damaged() const noexcept { return reader_.damaged(); }

 private:
  void repeat_tick(const Snapshot& newest);
  void take(const BehaviorInput& input);
  void take_over();
  void compare(std::span<const std::byte> recorded);
  void part(const std::string& what);

  void sent(std::span<const Command>, bool) noexcept override {}
  double parameter(double newest) noexcept override { return tick_.parameter(newest); }
  bool time_is_over(bool (*)(void*) noexcept, void*) noexcept override { return tick_.time_is_over(++looks_); }

  Supervisor& supervisor_;
  Decisions& decisions_;
  std::function<void(const BehaviorInput&)> write_file_;
  BehaviorInputReader reader_;
  TakenTick tick_;      // the next one
  bool waits_ = false;  // there is one
  Snapshot snapshot_;
  PlayReport report_;
  std::uint64_t ticks_ = 0;
  std::string parting_;
};

}  // namespace kadans

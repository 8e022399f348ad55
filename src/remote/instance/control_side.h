// The control thread's part of an instance: passes its row of signals to the ports that want it, and to the record
// while there is one. While nobody wants rows, it costs two relaxed loads for each port and tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "engine/tick/control_engine.h"
#include "engine/tick/record_sink.h"
#include "instance.h"
#include "realtime/engine_tasks.h"
#include "scenario/judge/truth_signals.h"

namespace kadans {

class ControlSide final : public RecordSink {
 public:
  // The instance must outlive this object. All ports must be open before the first tick.
  explicit ControlSide(Instance& instance) noexcept : instance_(instance) {}

  // Control thread.
  void record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept override;

  // Call it on one thread at a time. Rows go to `sink` from the current or the next tick on; nullptr: nowhere. The sink
  // must outlive the loop, because a row may still be on its way.
  void record_to(RecordSink* sink) noexcept { sink_.store(sink, std::memory_order_release); }

 private:
  Instance& instance_;
  std::atomic<RecordSink*> sink_{nullptr};
};

// Updates the truth signals of a model for the record. It runs on the control thread after the tick, because its
// signals are part of the control thread's row.
class TruthTask final : public BesideTick {
 public:
  // Both references must outlive this object.
  TruthTask(TruthSignals& truth, const ControlEngine& control) noexcept : truth_(truth), control_(control) {}
  void beside_tick(std::int64_t time_ns) override;

 private:
  TruthSignals& truth_;
  const ControlEngine& control_;
};

}  // namespace kadans

// The control thread's part of an instance: hands its row to whoever wants it, and to the record while there is one.
// Two relaxed loads a port and tick while nobody looks.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "kadans/engine/record_sink.h"
#include "kadans/remote/instance.h"

namespace kadans {

class ControlSide final : public RecordSink {
 public:
  // The instance must outlive it. All its ports are open by the first tick.
  explicit ControlSide(Instance& instance) noexcept : instance_(instance) {}

  // Control thread.
  void record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept override;

  // One thread at a time. From the next tick on, or the one that goes on, rows go there; nullptr: nowhere. The sink
  // must outlive the loop: a row may still be on its way.
  void record_to(RecordSink* sink) noexcept { sink_.store(sink, std::memory_order_release); }

 private:
  Instance& instance_;
  std::atomic<RecordSink*> sink_{nullptr};
};

}  // namespace kadans

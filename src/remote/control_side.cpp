#include "kadans/remote/control_side.h"

#include <cmath>

namespace kadans {

static_assert(std::atomic<RecordSink*>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void ControlSide::record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
  if (RecordSink* sink = sink_.load(std::memory_order_acquire); sink != nullptr) sink->record(tick, time_ns, row);
  for (const auto& port : instance_.ports()) port->row_.publish(tick, time_ns, row);
  instance_.console_row_.publish(tick, time_ns, row);
  stop_if_asked(time_ns);
}

void ControlSide::warm() noexcept {
  if (RecordSink* sink = sink_.load(std::memory_order_acquire); sink != nullptr) sink->warm();
  // A row without values goes nowhere, but finds out as others do whether somebody wants it.
  for (const auto& port : instance_.ports()) port->row_.publish(0, 0, {});
  instance_.console_row_.publish(0, 0, {});
}

// As at every way out: damping takes the speed, then the joints are off. Faults that are cleared meanwhile lift it.
void ControlSide::stop_if_asked(std::int64_t time_ns) noexcept {
  if (instance_.stop_now_.load(std::memory_order_relaxed)) {
    instance_.stop_now_.store(false, std::memory_order_relaxed);
    safety_.latch(SafetyLevel::damp);
    off_at_ns_ = time_ns + std::llround(safety_.settings().damp_s * 1e9);
  } else if (off_at_ns_ != INT64_MAX && safety_.robot_level() < SafetyLevel::damp) {
    off_at_ns_ = INT64_MAX;
  } else if (time_ns >= off_at_ns_) {
    safety_.latch(SafetyLevel::off);
    off_at_ns_ = INT64_MAX;
  }
}

}  // namespace kadans

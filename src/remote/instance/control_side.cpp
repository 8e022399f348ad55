
#include "control_side.h"

namespace kadans {

static_assert(std::atomic<RecordSink*>::is_always_lock_free);

void ControlSide::record(std::uint64_t tick, std::int64_t time_ns, std::span<const double> row) noexcept {
  if (RecordSink* sink = sink_.load(std::memory_order_acquire); sink != nullptr) sink->record(tick, time_ns, row);
  for (const auto& port : instance_.ports()) port->row_.publish(tick, time_ns, row);
  instance_.console_row_.publish(tick, time_ns, row);
}

void TruthTask::beside_tick(std::int64_t time_ns) {
  truth_.update(1e-9 * static_cast<double>(time_ns), control_.row());
}

}  // namespace kadans

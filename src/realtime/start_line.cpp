#include "start_line.h"

#include "engine/clock.h"

namespace kadans {

std::int64_t StartLine::wait() noexcept {
  if (missing_.fetch_sub(1, std::memory_order_acq_rel) == 1) open();
  return origin_ns();
}

std::int64_t StartLine::origin_ns() const noexcept {
  origin_ns_.wait(0, std::memory_order_acquire);
  return origin_ns_.load(std::memory_order_acquire);
}

void StartLine::open() noexcept {
  std::int64_t unknown = 0;
  origin_ns_.compare_exchange_strong(unknown, WallClock().now_ns() + lead_ns_, std::memory_order_acq_rel);
  origin_ns_.notify_all();
}

}  // namespace kadans

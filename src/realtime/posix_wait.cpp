#include "posix_wait.h"

#include <cerrno>

#include "wait.h"

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
  origin_ns_.compare_exchange_strong(unknown, monotonic_ns() + lead_ns_, std::memory_order_acq_rel);
  origin_ns_.notify_all();
}

namespace {

// More looks at the clock than the longest spin needs; a clock that stands still must not hold a real-time thread.
constexpr int looks_max = 10'000'000;

}  // namespace

void PosixWait::until(std::int64_t time_ns) noexcept {
  const timespec wake = timespec_of(time_ns + origin_ns_ - spin_ns_);
  const bool far = now_ns() < time_ns - spin_ns_;
  while (far && clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &wake, nullptr) == EINTR) {
  }
  for (int i = 0; i < looks_max && now_ns() < time_ns; ++i) relax();
}

}  // namespace kadans

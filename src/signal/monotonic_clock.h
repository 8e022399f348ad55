// The clock of this machine that nobody sets, and those that count a thread's own work. Any thread.
#pragma once

#include <cstdint>
#include <ctime>

#include "kadans/signal/frames.h"

namespace kadans {

// 0: there is no such clock.
inline std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec now{};
  if (clock_gettime(clock, &now) != 0) return 0;
  return std::int64_t{now.tv_sec} * ns_per_s + now.tv_nsec;
}

// A time or a duration as the system takes it.
inline timespec timespec_of(std::int64_t ns) noexcept {
  return {.tv_sec = static_cast<std::time_t>(ns / ns_per_s), .tv_nsec = static_cast<long>(ns % ns_per_s)};
}

inline std::int64_t monotonic_ns() noexcept { return clock_ns(CLOCK_MONOTONIC); }
// The CPU time of this thread, without the time of other threads. It asks the kernel, which costs about 0.7 us.
inline std::int64_t thread_cpu_ns() noexcept { return clock_ns(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace kadans

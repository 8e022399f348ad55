// The clock of this machine that nobody sets. Any thread.
#pragma once

#include <cstdint>
#include <ctime>

#include "kadans/signal/frames.h"

namespace kadans {

// CLOCK_MONOTONIC.
inline std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * ns_per_s + now.tv_nsec;
}

}  // namespace kadans

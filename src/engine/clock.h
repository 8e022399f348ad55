// The seam to time. Engines get the time as an argument; only what drives them reads a clock.
#pragma once

#include <cstdint>

#include "signal/monotonic_clock.h"

namespace kadans {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t now_ns() const noexcept = 0;
};

// Time that passes only by advance(): the plant's time leads.
class VirtualClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void advance(std::int64_t by_ns) noexcept { now_ns_ += by_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

// CLOCK_MONOTONIC.
class WallClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return monotonic_ns(); }
};

}  // namespace kadans

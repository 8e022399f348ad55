// Waiting on CLOCK_MONOTONIC: clock_nanosleep to an absolute time, then, if wanted, spinning over the last stretch.
//
// Waking a thread costs the kernel a timer interrupt and a switch: microseconds when the CPU is awake, tens of them on
// a virtual machine. A thread that wakes `spin_ns` early and watches the clock is late by one reading of the clock, as
// long as the wake-up itself took less than spin_ns. The price is that share of the CPU: 100 us of each 1 ms are 10 %.
// Spinning over whole periods would run into the kernel's limit for real-time threads (95 %, then they are stopped for
// 50 ms). With spin_ns = 0 it is a pure sleep, as a machine with one core needs it.
#pragma once

#include "start_line.h"
#include "wait.h"

namespace kadans {

inline constexpr std::int64_t default_spin_ns = 100'000;

class PosixWait final : public Wait {
 public:
  // Times count from `origin_ns` on CLOCK_MONOTONIC.
  explicit PosixWait(std::int64_t spin_ns = 0, std::int64_t origin_ns = 0) noexcept
      : spin_ns_(spin_ns), origin_ns_(origin_ns) {}

  // Times count from the opening of the line. The thread that will wait first waits at the line, as one of its tasks.
  PosixWait(std::int64_t spin_ns, StartLine& line) noexcept : spin_ns_(spin_ns), origin_ns_(0), line_(&line) {}

  void begin() noexcept override {
    if (line_ != nullptr) origin_ns_ = line_->wait();
  }
  std::int64_t now_ns() const noexcept override;
  void until(std::int64_t time_ns) noexcept override;  // signals do not shorten it

 private:
  std::int64_t spin_ns_;
  std::int64_t origin_ns_;
  StartLine* line_ = nullptr;
};

}  // namespace kadans

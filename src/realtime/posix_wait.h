// Waiting on CLOCK_MONOTONIC, and the line at which tasks wait for each other before time begins.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "signal/monotonic_clock.h"
#include "wait.h"

namespace kadans {

// Where tasks that beat together wait until all of them are there; then time begins for them.
//
// Threads are started one after the other, by a thread that is not in real time. A busy machine may hold that thread up
// for seconds between two of them. Without the line the first task would beat alone meanwhile: a control thread whose
// model is not yet there sees silent sensors.
//
// Threads: each task's thread calls wait() once; others ask or open() the line.
class StartLine {
 public:
  // Time 0 is `lead_ns` after the last of `tasks` came, on CLOCK_MONOTONIC.
  StartLine(std::size_t tasks, std::int64_t lead_ns) noexcept
      : missing_(static_cast<std::uint32_t>(tasks)), lead_ns_(lead_ns) {}

  // A task's thread, once: returns time 0 when all are there.
  std::int64_t wait() noexcept;
  // Any thread: waits for time 0 as well, but is not counted as a task.
  std::int64_t origin_ns() const noexcept;
  // Any thread: whether the line is open: all are there, or open() was called.
  bool is_open() const noexcept { return origin_ns_.load(std::memory_order_acquire) != 0; }
  // Opens the line although not all tasks will come.
  void open() noexcept;

 private:
  std::atomic<std::uint32_t> missing_;
  std::int64_t lead_ns_;
  std::atomic<std::int64_t> origin_ns_{0};  // 0: not yet known
};

// Waiting on CLOCK_MONOTONIC: clock_nanosleep to an absolute time, then, if wanted, spinning over the last stretch.
//
// Waking a thread costs the kernel a timer interrupt and a switch: microseconds when the CPU is awake, tens of them on
// a virtual machine. A thread that wakes `spin_ns` early and watches the clock is late by one reading of the clock, as
// long as the wake-up itself took less than spin_ns. The price is that share of the CPU: 100 us of each 1 ms are 10 %.
// Spinning over whole periods would run into the kernel's limit for real-time threads (95 %, then they are stopped for
// 50 ms). With spin_ns = 0 it is a pure sleep, as a machine with one core needs it.
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
  std::int64_t now_ns() const noexcept override { return monotonic_ns() - origin_ns_; }
  void until(std::int64_t time_ns) noexcept override;  // signals do not shorten it

 private:
  std::int64_t spin_ns_;
  std::int64_t origin_ns_;
  StartLine* line_ = nullptr;
};

}  // namespace kadans

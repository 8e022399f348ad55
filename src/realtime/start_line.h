// Where tasks that beat together wait until all of them are there; then time begins for them.
//
// Threads are started one after the other, by a thread that is not in real time. A busy machine may hold that thread up
// for seconds between two of them. Without the line the first task would beat alone meanwhile: a control thread whose
// model is not yet there sees silent sensors.
//
// Threads: each task's thread calls wait() once; others ask or open() the line.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace kadans {

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

}  // namespace kadans

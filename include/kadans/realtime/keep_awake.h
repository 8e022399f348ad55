// Keeps a CPU from idling: a thread of the lowest class there is (SCHED_IDLE) that spins on it and gives way to
// whatever else wants to run. An idle CPU sleeps deeper the longer it idles, and a virtual one leaves to its host;
// waking it takes several times what waking a thread on a busy one does. It costs that CPU's rest: power, heat, a
// host's time.
//
// Also holds /dev/cpu_dma_latency at 0, where that may be written: then no CPU leaves for a deep sleep.
#pragma once

#include <atomic>
#include <cstdint>

#include <pthread.h>

namespace kadans {

class KeepAwake {
 public:
  // Throws std::system_error when there can be no thread.
  explicit KeepAwake(int cpu);
  ~KeepAwake();
  KeepAwake(const KeepAwake&) = delete;
  KeepAwake& operator=(const KeepAwake&) = delete;

  std::int64_t cpu_time_ns() const noexcept;
  bool holds_latency() const noexcept { return latency_ >= 0; }

 private:
  static void* spin(void* self);

  int cpu_;
  int latency_ = -1;  // file descriptor; closing it lets go
  std::atomic<bool> stop_{false};
  pthread_t thread_{};
};

}  // namespace kadans

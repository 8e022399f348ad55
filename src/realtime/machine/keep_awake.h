// Keeps a CPU from idling: a thread of the lowest scheduling class (SCHED_IDLE) spins on it and gives way to every
// other thread. The longer a CPU idles, the deeper it sleeps; an idle virtual CPU is given back to its host. Waking it
// then takes several times as long as waking a thread on a busy CPU. The price is power, heat, and the host's time.
//
// Also holds /dev/cpu_dma_latency at 0, if it may be written: then no CPU goes into a deep sleep.
#pragma once

#include <atomic>
#include <cstdint>

#include <pthread.h>

#include "signal/owned_descriptor.h"

namespace kadans {

class KeepAwake {
 public:
  // Throws std::system_error when there can be no thread.
  explicit KeepAwake(int cpu);
  ~KeepAwake();
  KeepAwake(const KeepAwake&) = delete;
  KeepAwake& operator=(const KeepAwake&) = delete;

  std::int64_t cpu_time_ns() const noexcept;
  bool holds_latency() const noexcept { return static_cast<bool>(latency_); }

 private:
  void spin() const noexcept;

  int cpu_;
  OwnedDescriptor latency_;  // closing it lets go
  std::atomic<bool> stop_{false};
  pthread_t thread_{};
};

}  // namespace kadans

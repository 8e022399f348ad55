#include "keep_awake.h"

#include <system_error>

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include "realtime/wait.h"
#include "signal/monotonic_clock.h"
#include "signal/quiet_thread.h"

namespace kadans {

KeepAwake::KeepAwake(int cpu) : cpu_(cpu), latency_(open("/dev/cpu_dma_latency", O_WRONLY | O_CLOEXEC)) {
  const std::int32_t wanted_us = 0;
  if (latency_ && write(latency_.number(), &wanted_us, sizeof wanted_us) != sizeof wanted_us) latency_ = {};
  const int error = start_quiet_thread<&KeepAwake::spin>(
      thread_, {.name = "keep-awake", .stack_bytes = std::size_t{64} * 1024}, this);
  if (error != 0) throw std::system_error(error, std::generic_category(), "no thread to keep the CPU awake");
}

KeepAwake::~KeepAwake() {
  stop_.store(true, std::memory_order_relaxed);
  // Where others take its CPU, a thread that takes idle time alone never comes to see that: so it need not be idle any
  // more, or, without the right to that, may go to another CPU.
  const sched_param usual{};
  (void)pthread_setschedparam(thread_, SCHED_OTHER, &usual);
  cpu_set_t all;
  if (sched_getaffinity(getpid(), sizeof all, &all) == 0) (void)pthread_setaffinity_np(thread_, sizeof all, &all);
  pthread_join(thread_, nullptr);
}

void KeepAwake::spin() const noexcept {
  const sched_param lowest{};
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<std::size_t>(cpu_), &cpus);
  // In any other class it would take time from others: then rather not.
  if (pthread_setschedparam(pthread_self(), SCHED_IDLE, &lowest) != 0 ||
      pthread_setaffinity_np(pthread_self(), sizeof cpus, &cpus) != 0)
    return;
  while (!stop_.load(std::memory_order_relaxed)) relax();
}

std::int64_t KeepAwake::cpu_time_ns() const noexcept {
  clockid_t clock{};
  return pthread_getcpuclockid(thread_, &clock) == 0 ? clock_ns(clock) : 0;
}

}  // namespace kadans

// The timing test: how late a periodic task that does nothing wakes on this machine, in the ways the runtime can wait.
// For comparison the same by cyclictest, the common yardstick, on the same CPU at the same priority.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "realtime/task_thread.h"

namespace kadans {

struct JitterSettings {
  int cpu = 0;
  int priority = 90;  // of SCHED_FIFO; 0: not a real-time thread
  std::int64_t period_ns = 1'000'000;
  std::int64_t spin_ns = 0;  // 0: pure sleep
  std::uint64_t samples = 10'000;
};

struct JitterSample {
  TaskStatistics statistics;
  std::int64_t cpu_time_ns = 0;
  int refused_priority = 0, refused_cpu = 0;  // errno; 0: none
};

// Takes samples * period. Throws std::system_error when there can be no thread.
JitterSample measure_jitter(const JitterSettings& settings);

// Wake-up lateness of cyclictest's samples. The jitter is taken from their differences, because its time grid is like
// ours.
struct YardstickSample {
  TickStatistics lateness, jitter;
};
// Nothing when cyclictest is not installed or does not run.
std::optional<YardstickSample> measure_cyclictest(const JitterSettings& settings);
// One line of `cyclictest -v -N`: "       0:    1997:   24314", thread, sample, lateness in ns. Nothing for other
// lines.
std::optional<std::int64_t> cyclictest_lateness_ns(const std::string& line);

}  // namespace kadans

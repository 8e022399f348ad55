#include "placement.h"

#include <cerrno>
#include <fstream>

#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

namespace kadans {

int leave_cpu(int cpu) noexcept {
  cpu_set_t cpus;
  if (sched_getaffinity(0, sizeof cpus, &cpus) != 0) return errno;
  if (CPU_COUNT(&cpus) < 2) return 0;
  CPU_CLR(static_cast<std::size_t>(cpu), &cpus);
  return sched_setaffinity(0, sizeof cpus, &cpus) == 0 ? 0 : errno;
}

int take_priority(int priority) noexcept {
  sched_param parameter{};
  parameter.sched_priority = priority;
  return sched_setscheduler(0, SCHED_FIFO, &parameter) == 0 ? 0 : errno;
}

void be_first_victim() noexcept { std::ofstream("/proc/self/oom_score_adj") << 500; }

int limit_memory(unsigned long long more_bytes) noexcept {
  unsigned long long pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  rlimit limit{};
  limit.rlim_cur = limit.rlim_max =
      static_cast<rlim_t>(pages * static_cast<unsigned long long>(sysconf(_SC_PAGESIZE)) + more_bytes);
  return setrlimit(RLIMIT_AS, &limit) == 0 ? 0 : errno;
}

}  // namespace kadans

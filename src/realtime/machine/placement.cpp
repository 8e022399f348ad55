
#include "placement.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>

#include <malloc.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
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

namespace {

constexpr std::size_t page = 4096;

// With what is locked, a thread's stack must still fit the limit: else no thread could be started.
bool has_room_to_come() noexcept {
  constexpr std::size_t stacks_bytes = std::size_t{64} << 20U;
  void* const room = mmap(nullptr, stacks_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return room != MAP_FAILED && munmap(room, stacks_bytes) == 0;
}

}  // namespace

int lock_memory(std::size_t reserve_bytes) noexcept {
  mallopt(M_TRIM_THRESHOLD, -1);
  mallopt(M_MMAP_MAX, 0);
  auto* const reserve = static_cast<volatile char*>(std::malloc(reserve_bytes));
  for (std::size_t i = 0; reserve != nullptr && i < reserve_bytes; i += page) reserve[i] = 0;
  std::free(const_cast<char*>(reserve));
  int refused = 0;
  if (mlockall(MCL_CURRENT) != 0 || mlockall(MCL_FUTURE | MCL_ONFAULT) != 0) refused = errno;
  if (refused == 0 && !has_room_to_come()) refused = ENOMEM;
  if (refused != 0) (void)munlockall();
  return refused;
}

// What the thread's own variables take of a stack differs: a sanitizer's are large.
void touch_stack() noexcept {
  constexpr std::size_t reserve = 16 * 1024, most = 256 * 1024;
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return;
  void* lowest = nullptr;
  std::size_t size = 0;
  pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  const auto* const here = static_cast<const char*>(__builtin_frame_address(0));
  const auto left = static_cast<std::size_t>(here - static_cast<const char*>(lowest));
  if (left <= 2 * reserve) return;
  const std::size_t touched = std::min(left - 2 * reserve, most);
  auto* const deep = static_cast<volatile char*>(__builtin_alloca(touched));
  for (std::size_t i = 0; i < touched; i += page) deep[i] = 0;
}

}  // namespace kadans

#include <array>
#include <cstring>
#include <thread>

#include <doctest/doctest.h>
#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "realtime/machine/placement.h"

using namespace kadans;

namespace {

// What a user without the right may do, for the rest of this process.
bool become_a_user_who_may_lock(rlim_t bytes) {
  const rlimit limit{.rlim_cur = bytes, .rlim_max = bytes};
  if (setrlimit(RLIMIT_MEMLOCK, &limit) != 0) return false;
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  const std::array<__user_cap_data_struct, 2> none{};
  return syscall(SYS_capset, &header, none.data()) == 0;
}

// In a process of its own, whose exit code tells: 0 locked, 1 refused, and then another thread started; 2 it did not;
// 3 this user cannot have that limit.
int locked_and_a_thread_started(rlim_t limit) {
  const pid_t child = fork();
  if (child == 0) {
    if (!become_a_user_who_may_lock(limit)) _exit(3);
    const int refused = lock_memory(1 << 16U);
    try {
      std::thread([] {}).join();
    } catch (const std::system_error&) {
      _exit(2);
    }
    _exit(refused == 0 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

#ifdef KADANS_SANITIZED
constexpr bool locks = false;  // the sanitizers let nothing be locked
#else
constexpr bool locks = true;
#endif

TEST_CASE("Where memory may not be locked none is, so that threads can be started" * doctest::skip(!locks)) {
  CHECK(locked_and_a_thread_started(rlim_t{4} << 20U) == 1);  // less than the program
  const int without_threads = locked_and_a_thread_started(rlim_t{64} << 20U);
  CHECK((without_threads == 1 || without_threads == 3));
  const int with_threads = locked_and_a_thread_started(rlim_t{3} << 30U);
  CHECK((with_threads == 0 || with_threads == 3));
}

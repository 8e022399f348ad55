// Ends the process when what must end does not: a thread of its own that sleeps until a deadline passes, then says what
// hangs and leaves by _exit, with the exit code of a run that failed. So whatever one part waits for, a run ends.
//
// With the right to it the thread runs in real time above all others: a thread that keeps a CPU to itself does not keep
// it from its work. It calls nothing that could wait for another thread: no allocation, no lock that others hold.
#pragma once

#include <atomic>
#include <cstdint>

#include <pthread.h>

namespace kadans {

class LastResort {
 public:
  // `priority`: of SCHED_FIFO, 0: the usual. Throws std::system_error when there can be no thread.
  LastResort(int priority, int exit_code);
  ~LastResort();  // nothing is expected any more
  LastResort(const LastResort&) = delete;
  LastResort& operator=(const LastResort&) = delete;

  // From now on `what` must be over within the time, in place of what was expected before. `what` is not copied.
  void expect(const char* what, std::int64_t within_ns) noexcept;

 private:
  static void* enter(void* self);
  void watch() noexcept;

  int exit_code_;
  int wake_;
  std::atomic<const char*> what_{nullptr};
  std::atomic<std::int64_t> deadline_ns_{INT64_MAX};
  std::atomic<bool> over_{false};
  pthread_t thread_{};
};

}  // namespace kadans

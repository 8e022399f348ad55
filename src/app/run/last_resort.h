// A watchdog for the end of the process. A thread of its own sleeps until a deadline passes, then says what hangs and
// calls _exit with the given exit code. So a run ends even when one of its parts hangs.
//
// With the right to do so, the thread runs in real time above all others, so a thread that occupies a CPU cannot stop
// it. It calls nothing that could wait for another thread: no allocation, no lock that others hold.
#pragma once

#include <atomic>
#include <cstdint>

#include <pthread.h>

#include "signal/owned_descriptor.h"

namespace kadans {

class LastResort {
 public:
  // `priority` is that of SCHED_FIFO; 0: normal scheduling. Throws std::system_error when no thread can be made.
  LastResort(int priority, int exit_code);
  ~LastResort();  // ends the watch
  LastResort(const LastResort&) = delete;
  LastResort& operator=(const LastResort&) = delete;

  // From now on `what` must end within within_ns; this replaces the earlier expectation. `what` is not copied.
  void expect(const char* what, std::int64_t within_ns) noexcept;

 private:
  static void* enter(void* self);
  void watch() noexcept;

  int exit_code_;
  OwnedDescriptor wake_;
  std::atomic<const char*> what_{nullptr};
  std::atomic<std::int64_t> deadline_ns_{INT64_MAX};
  std::atomic<bool> over_{false};
  pthread_t thread_{};
};

}  // namespace kadans

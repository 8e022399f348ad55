// Threads that signals do not disturb: they go to the thread that waits for them.
#pragma once

#include <csignal>
#include <cstddef>

#include <pthread.h>

namespace kadans {

// Blocks all signals in the thread that makes it, for as long as it lives. Threads that are started meanwhile block
// them for good.
class SignalsBlocked {
 public:
  SignalsBlocked() noexcept {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

struct QuietThreadSettings {
  const char* name;         // at most 15 characters, shown by ps and top
  std::size_t stack_bytes;  // all of it may be locked memory
  int priority = 0;         // of SCHED_FIFO, from its first instruction on; 0: as the thread that starts it
};

// Starts a thread that blocks all signals and calls this member of the object. Returns 0, or the error with which the
// system refuses it.
template <auto Member, typename Object>
int start_quiet_thread(pthread_t& thread, const QuietThreadSettings& wanted, Object* object) noexcept {
  const auto enter = [](void* self) -> void* {
    (static_cast<Object*>(self)->*Member)();
    return nullptr;
  };
  const SignalsBlocked blocked;
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, wanted.stack_bytes);
  int error = 0;
  if (wanted.priority > 0) {
    sched_param parameter{};
    parameter.sched_priority = wanted.priority;
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    pthread_attr_setschedpolicy(&attributes, SCHED_FIFO);
    error = pthread_attr_setschedparam(&attributes, &parameter);
  }
  if (error == 0) error = pthread_create(&thread, &attributes, enter, object);
  pthread_attr_destroy(&attributes);
  if (error == 0) pthread_setname_np(thread, wanted.name);
  return error;
}

}  // namespace kadans

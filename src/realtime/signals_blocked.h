// Blocks all signals in the thread that makes it, for as long as it lives. Threads that are started meanwhile block
// them for good. So signals disturb only the thread that waits for them.
#pragma once

#include <csignal>

#include <pthread.h>

namespace kadans {

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

}  // namespace kadans

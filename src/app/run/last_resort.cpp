#include "last_resort.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <poll.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include "engine/clock.h"
#include "signal/quiet_thread.h"

namespace kadans {
namespace {

void say(const char* text) noexcept { (void)!write(STDERR_FILENO, text, std::strlen(text)); }

}  // namespace

LastResort::LastResort(int priority, int exit_code)
    : exit_code_(exit_code), wake_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!wake_) throw std::system_error(errno, std::generic_category(), "eventfd");
  const SignalsBlocked blocked;
  if (const int failed = pthread_create(&thread_, nullptr, enter, this); failed != 0)
    throw std::system_error(failed, std::generic_category(), "the thread that ends what hangs");
  sched_param parameter{};
  parameter.sched_priority = priority;
  if (priority > 0) (void)pthread_setschedparam(thread_, SCHED_FIFO, &parameter);
}

LastResort::~LastResort() {
  over_.store(true);
  (void)eventfd_write(wake_.number(), 1);
  pthread_join(thread_, nullptr);
}

void LastResort::expect(const char* what, std::int64_t within_ns) noexcept {
  what_.store(what);
  deadline_ns_.store(WallClock().now_ns() + within_ns);
  (void)eventfd_write(wake_.number(), 1);
}

void* LastResort::enter(void* self) {
  static_cast<LastResort*>(self)->watch();
  return nullptr;
}

void LastResort::watch() noexcept {
  constexpr std::int64_t longest_ms = 3'600'000;
  while (!over_.load()) {
    const std::int64_t deadline_ns = deadline_ns_.load();
    const std::int64_t left_ns = deadline_ns == INT64_MAX ? INT64_MAX : deadline_ns - WallClock().now_ns();
    if (left_ns <= 0) {
      say("error: ");
      say(what_.load());
      say(" hangs; the run ends without it\n");
      _exit(exit_code_);
    }
    pollfd watched{.fd = wake_.number(), .events = POLLIN, .revents = 0};
    if (poll(&watched, 1, static_cast<int>(std::min(left_ns / 1'000'000 + 1, longest_ms))) <= 0) continue;
    eventfd_t ignored = 0;
    (void)eventfd_read(wake_.number(), &ignored);
  }
}

}  // namespace kadans

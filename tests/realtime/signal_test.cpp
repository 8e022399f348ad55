// Signals to the process must not reach its tasks, nor end a wait early.
#include <atomic>
#include <csignal>
#include <thread>

#include <doctest/doctest.h>
#include <pthread.h>
#include <unistd.h>

#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"

using namespace kadans;

namespace {

std::atomic<int> handled{0};
thread_local bool is_task = false;
std::atomic<int> handled_in_task{0};

void handle(int) {
  handled.fetch_add(1);
  if (is_task) handled_in_task.fetch_add(1);
}

class Handler {
 public:
  Handler() {
    struct sigaction action = {};
    action.sa_handler = handle;
    sigaction(SIGUSR1, &action, &before_);
  }
  ~Handler() { sigaction(SIGUSR1, &before_, nullptr); }
  Handler(const Handler&) = delete;
  Handler& operator=(const Handler&) = delete;

 private:
  struct sigaction before_ = {};
};

class Beats final : public Task {
 public:
  bool beat(const Beat&) override {
    is_task = true;
    return ++beats < 50;
  }
  int beats = 0;
};

}  // namespace

TEST_CASE("A storm of signals hits none of a task's beats") {
  const Handler handler;
  PosixWait wait;
  Beats task;
  TaskThread thread({.name = "storm", .first_ns = wait.now_ns()}, task, wait);
  thread.start();
  while (!thread.over()) kill(getpid(), SIGUSR1);
  thread.join();
  CHECK(task.beats == 50);
  CHECK(handled.load() > 0);
  CHECK(handled_in_task.load() == 0);
}

TEST_CASE("A signal does not end a wait before its time") {
  const Handler handler;
  std::atomic<bool> over{false};
  std::int64_t early_ns = 0;
  std::thread waiting([&] {
    PosixWait wait(10'000);
    const std::int64_t due_ns = wait.now_ns() + 20'000'000;
    wait.until(due_ns);
    early_ns = due_ns - wait.now_ns();
    over.store(true);
  });
  while (!over.load()) pthread_kill(waiting.native_handle(), SIGUSR1);
  waiting.join();
  CHECK(early_ns <= 0);
}

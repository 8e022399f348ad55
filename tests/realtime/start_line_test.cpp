#include <atomic>

#include <doctest/doctest.h>

#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"

using namespace kadans;

namespace {

struct Once final : Task {
  bool beat(const Beat& beat) override {
    woke_ns = beat.woke_ns;
    beats.fetch_add(1);
    return false;
  }
  std::atomic<int> beats{0};
  std::int64_t woke_ns = 0;
};

}  // namespace

TEST_CASE("No task beats before the last one has come, and time is the same for all") {
  StartLine line(3, 1'000'000);
  PosixWait wait_a(0, line), wait_b(0, line);
  Once a, b;
  TaskThread thread_a({.name = "a"}, a, wait_a), thread_b({.name = "b"}, b, wait_b);
  thread_a.start();
  thread_b.start();
  CHECK(a.beats + b.beats == 0);
  const std::int64_t before_ns = WallClock().now_ns();
  const std::int64_t origin_ns = line.wait();
  CHECK(origin_ns >= before_ns + 1'000'000);
  CHECK(line.origin_ns() == origin_ns);
  thread_a.join();
  thread_b.join();
  CHECK(a.beats == 1);
  CHECK(b.beats == 1);
  CHECK(a.woke_ns >= 0);
  CHECK(a.woke_ns < WallClock().now_ns() - origin_ns + 1);
}

TEST_CASE("A line that is opened lets those go who wait for one that does not come") {
  StartLine line(2, 0);
  PosixWait wait(0, line);
  Once task;
  TaskThread thread({.name = "alone"}, task, wait);
  thread.start();
  thread.stop();
  line.open();
  thread.join();
  CHECK(thread.over());
  CHECK(task.beats <= 1);
}

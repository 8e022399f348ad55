#include "realtime/task_thread.h"

#include <stdexcept>

#include <doctest/doctest.h>

#include "fake_wait.h"
#include "realtime/machine/jitter.h"

using namespace kadans;

namespace {

class Counter final : public Task {
 public:
  bool beat(const Beat& beat) override {
    last = beat;
    if (++beats == throw_at) throw std::runtime_error("the work failed");
    return beats < end_at;
  }
  int beats = 0, end_at = 1000, throw_at = 0;
  Beat last;
};

// Takes its time over what it prepares.
class Preparer final : public Task {
 public:
  Preparer(FakeWait& wait, std::int64_t takes_ns) : wait_(wait), takes_ns_(takes_ns) {}
  bool beat(const Beat& beat) override {
    late_ns = beat.woke_ns - beat.due_ns;
    return ++beats < 10;
  }
  void prepare() noexcept override {
    ++prepared;
    wait_.work(takes_ns_);
    ended_ns = wait_.now_ns();
  }
  int beats = 0, prepared = 0;
  std::int64_t late_ns = 0, ended_ns = 0;

 private:
  FakeWait& wait_;
  std::int64_t takes_ns_;
};

}  // namespace

TEST_CASE("A task beats on its own thread until it says that it is over") {
  Counter counter;
  FakeWait wait;
  TaskThread thread({.name = "count", .first_ns = 0}, counter, wait);
  CHECK_FALSE(thread.over());
  thread.start();
  thread.join();
  CHECK(thread.over());
  CHECK(counter.beats == 1000);
  CHECK(counter.last.due_ns == 999'000'000);
  CHECK(thread.statistics().lateness.count() == 1000);
  CHECK(std::string(thread.failure()).empty());
  CHECK(thread.cpu_time_ns() > 0);
}

TEST_CASE("A task prepares over and over until it would be late, so that the last time is just before its beat") {
  FakeWait wait;
  Preparer quick(wait, 3'000);
  TaskThread thread({.name = "prepare", .first_ns = 1'000'000, .prepare_ns = 25'000}, quick, wait);
  thread.start();
  thread.join();
  CHECK(quick.prepared == 10 * 7);  // an eighth could end late if it took twice as long
  CHECK(quick.ended_ns == 10'000'000 - 4'000);
  CHECK(quick.late_ns == 0);
  CHECK(thread.preparation().count() == 70);
}

TEST_CASE("What takes longer to prepare than there is time is prepared once") {
  FakeWait wait;
  Preparer slow(wait, 30'000);
  TaskThread thread({.name = "prepare", .first_ns = 1'000'000, .prepare_ns = 25'000}, slow, wait);
  thread.start();
  thread.join();
  CHECK(slow.prepared == 10);
  CHECK(slow.late_ns == 5'000);
}

TEST_CASE("An exception ends a task, and its words are kept") {
  Counter counter;
  counter.throw_at = 3;
  FakeWait wait;
  TaskThread thread({.name = "throw"}, counter, wait);
  thread.start();
  thread.join();
  CHECK(counter.beats == 3);
  CHECK(std::string(thread.failure()) == "the work failed");
}

TEST_CASE("A task whose clock stands still gives up instead of spinning") {
  Counter counter;
  FakeWait wait;
  wait.frozen = true;
  TaskThread thread({.name = "frozen", .first_ns = 1}, counter, wait);
  thread.start();
  thread.join();
  CHECK(counter.beats == 0);
  CHECK(std::string(thread.failure()) == "the clock stands still");
}

TEST_CASE("A priority or CPU that the system refuses is told, and the task runs all the same") {
  Counter counter;
  FakeWait wait;
  TaskThread thread({.name = "refused", .priority = 1000, .cpu = 1023}, counter, wait);
  thread.start();
  thread.join();
  CHECK(counter.beats == 1000);
  CHECK(thread.refused_priority() != 0);
  CHECK(thread.refused_cpu() != 0);
}

TEST_CASE("Lines of cyclictest are samples, or not") {
  CHECK(cyclictest_lateness_ns("       0:    1997:   24314\n") == 24314);
  CHECK_FALSE(cyclictest_lateness_ns("# /dev/cpu_dma_latency set to 0us\n"));
  CHECK_FALSE(cyclictest_lateness_ns("Thread 0 Interval: 1500\n"));
  CHECK_FALSE(cyclictest_lateness_ns("0: 1\n"));
  CHECK_FALSE(cyclictest_lateness_ns("0: 1:\n"));
  CHECK_FALSE(cyclictest_lateness_ns(""));
}

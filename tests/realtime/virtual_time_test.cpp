#include "realtime/virtual_time.h"

#include <array>
#include <vector>

#include <doctest/doctest.h>

#include "realtime/task_thread.h"

using namespace kadans;

namespace {

// Counts its beats and looks at what the others have counted.
class Counting final : public Task {
 public:
  explicit Counting(int until) : left_(until) {}
  bool beat(const Beat& beat) override {
    on_time = on_time && beat.woke_ns == beat.due_ns && beat.missed == 0;
    last_ns = beat.woke_ns;
    return --left_ > 0;
  }
  bool on_time = true;
  std::int64_t last_ns = 0;

 private:
  int left_;
};

}  // namespace

TEST_CASE("Threads on virtual time all beat on the grid, however many there are and however fast the machine") {
  VirtualTime time;
  std::vector<std::unique_ptr<Wait>> waits;
  std::vector<std::unique_ptr<Counting>> tasks;
  std::vector<std::unique_ptr<TaskThread>> threads;
  for (std::int64_t i = 1; i <= 5; ++i) {
    waits.push_back(time.make_wait());
    tasks.push_back(std::make_unique<Counting>(500));
    threads.push_back(std::make_unique<TaskThread>(
        TaskSettings{.name = "task", .period_ns = i * 1'000'000, .first_ns = i}, *tasks.back(), *waits.back()));
  }
  for (const auto& thread : threads) thread->start();
  for (const auto& thread : threads) thread->join();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const auto n = static_cast<std::int64_t>(i) + 1;
    CHECK(tasks[i]->on_time);
    CHECK(tasks[i]->last_ns == n + 499 * n * 1'000'000);
  }
  CHECK(time.now_ns() == 5 + 499 * 5'000'000LL);
}

TEST_CASE("Time stands while somebody has not said until when to wait") {
  VirtualTime time;
  const std::unique_ptr<Wait> mine = time.make_wait(), other = time.make_wait();
  Counting task(3);
  TaskThread thread({.name = "task", .first_ns = 10}, task, *other);
  thread.start();
  CHECK(time.now_ns() == 0);  // the task may wait already or not: this thread works
  mine->until(5);
  CHECK(time.now_ns() == 5);
  CHECK(task.last_ns == 0);
  mine->until(10'000'000);
  CHECK(time.now_ns() == 10'000'000);
  thread.join();
  CHECK(task.last_ns == 2'000'010);
}

TEST_CASE("Waiting for what is past returns at once, and time goes on without who left") {
  VirtualTime time;
  const std::unique_ptr<Wait> mine = time.make_wait(), other = time.make_wait();
  other->end();
  mine->until(100);
  mine->until(50);
  CHECK(time.now_ns() == 100);
}

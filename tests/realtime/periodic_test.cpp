#include <doctest/doctest.h>

#include "fake_wait.h"
#include "realtime/task_thread.h"

namespace periodic_test {

using namespace kadans;

namespace {

constexpr std::int64_t period_ns = 1'000'000;

struct FakeTask {
  FakeWait wait;
  Periodic periodic{wait, period_ns, 5'000'000};

  Beat beat(std::int64_t work_ns = 100'000) {
    const Beat beat = periodic.next();
    wait.work(work_ns);
    if (!beat.stands) periodic.done();
    return beat;
  }
};

}  // namespace

TEST_CASE("Beats come on the grid from the first on") {
  FakeTask task;
  for (std::uint64_t i = 0; i < 5; ++i) {
    const Beat beat = task.beat();
    CHECK(beat.number == i);
    CHECK(beat.woke_ns == 5'000'000 + static_cast<std::int64_t>(i) * period_ns);
    CHECK(beat.dt_s == doctest::Approx(0.001));
    CHECK(beat.missed == 0);
  }
  CHECK(task.periodic.statistics().jitter.max_ns() == 0);
  CHECK(task.periodic.statistics().execution.min_ns() == 100'000);
}

TEST_CASE("A wake-up that is late within its period is handed on as it is and leaves the grid where it was") {
  FakeTask task;
  (void)task.beat();
  task.wait.late_ns = 300'000;
  const Beat late = task.beat();
  CHECK(late.missed == 0);
  CHECK(late.dt_s == doctest::Approx(0.0013));
  const Beat next = task.beat();
  CHECK(next.woke_ns == 7'000'000);
  CHECK(next.dt_s == doctest::Approx(0.0007));
  CHECK(task.periodic.statistics().lateness.max_ns() == 300'000);
  CHECK(task.periodic.statistics().jitter.count() == 2);  // both intervals are off by as much
  CHECK(task.periodic.statistics().jitter.min_ns() == 300'000);
}

TEST_CASE("After a wake-up late by more than half a period the next grid point is too close and left out") {
  FakeTask task;
  (void)task.beat();
  task.wait.late_ns = 600'000;
  CHECK(task.beat().missed == 0);
  const Beat next = task.beat();
  CHECK(next.missed == 1);
  CHECK(next.woke_ns == 8'000'000);
  CHECK(next.dt_s == doctest::Approx(0.0014));
}

TEST_CASE("Work longer than the period costs the beats it covers, and there is a wait before the next") {
  FakeTask task;
  (void)task.beat(2'400'000);  // over the points 1 and 2
  const Beat next = task.beat();
  CHECK(next.number == 3);
  CHECK(next.missed == 2);
  CHECK(next.dt_s == doctest::Approx(0.003));
  CHECK(next.woke_ns == 8'000'000);
  CHECK(task.periodic.statistics().overruns.get() == 1);
  CHECK(task.periodic.statistics().missed.get() == 2);
  CHECK(task.beat().missed == 0);
}

TEST_CASE("A task that is always too slow never beats twice in a period") {
  FakeTask task;
  std::int64_t last_ns = 0;
  for (int i = 0; i < 20; ++i) {
    const Beat beat = task.beat(1'100'000);
    if (i > 0) CHECK(beat.woke_ns - last_ns == 2 * period_ns);
    last_ns = beat.woke_ns;
  }
}

TEST_CASE("Waking whole periods late leaves them out, and no burst follows") {
  FakeTask task;
  (void)task.beat();
  task.wait.late_ns = 4'300'000;
  const Beat late = task.beat();
  CHECK(late.number == 5);
  CHECK(late.missed == 4);
  CHECK(late.dt_s == doctest::Approx(0.0053));
  const Beat next = task.beat();
  CHECK(next.number == 6);
  CHECK(next.missed == 0);
  CHECK(next.woke_ns == 11'000'000);
  CHECK(task.periodic.statistics().late_wakes.get() == 1);
  CHECK(task.periodic.statistics().lateness.max_ns() == 4'300'000);
}

TEST_CASE("While the clock stands still there is nothing to do, and what was missed is told when it goes on") {
  FakeTask task;
  (void)task.beat(1'200'000);
  task.wait.frozen = true;
  for (int i = 0; i < 3; ++i) CHECK(task.beat(0).stands);
  task.wait.frozen = false;
  const Beat beat = task.beat();
  CHECK_FALSE(beat.stands);
  CHECK(beat.missed == 1);
  CHECK(beat.number == 2);
  CHECK(task.periodic.statistics().lateness.count() == 2);
}

}  // namespace periodic_test

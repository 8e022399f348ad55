#include "kadans/testing/real_time_guard.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <stdlib.h>
#include <time.h>

#include "testing/doomed.h"

namespace kadans::testing {

// With a name that a stack trace can show.
__attribute__((noinline)) void careless_controller() { test::keep(malloc(32)); }

namespace {

using test::Ending;
using test::keep;
using test::run_in_child;

TEST_CASE("a guarded thread may compute, format into a buffer, read the clock and free nothing") {
  std::vector<double> row(100, 2.0);
  char text[64];
  timespec now{};
  double sum = 0;
  {
    const RealTimeGuard guard;
    for (const double value : row) sum += std::sqrt(value);
    snprintf(text, sizeof text, "%d %.3f", 7, 0.5);
    clock_gettime(CLOCK_MONOTONIC, &now);
    free(nullptr);
  }
  CHECK(sum > 0);
  CHECK(std::strcmp(text, "7 0.500") == 0);
  CHECK(now.tv_nsec >= 0);
}

TEST_CASE("the trace of a forbidden call names the functions on the way to it") {
  const Ending ending = run_in_child([] {
    const RealTimeGuard guard;
    careless_controller();
  });
  CHECK(ending.aborted);
  CHECK(ending.says("malloc called by a real-time thread"));
  CHECK(ending.says("real_time_guard_test.cpp:"));
  CHECK(ending.says("kadans::testing::careless_controller()"));
  CHECK(ending.says("testing_test"));
}

TEST_CASE("after its guard a thread is free again") {
  { const RealTimeGuard guard; }
  const auto block = std::make_unique<int>(1);
  CHECK(*block == 1);
}

TEST_CASE("guards nest: the inner one's end does not free the thread") {
  const Ending ending = run_in_child([] {
    const RealTimeGuard outer("outer.cpp", 1);
    { const RealTimeGuard inner("inner.cpp", 2); }
    careless_controller();
  });
  CHECK(ending.aborted);
  CHECK(ending.says("guarded at outer.cpp:1"));
}

TEST_CASE("the innermost guard is the one that is told") {
  const Ending ending = run_in_child([] {
    const RealTimeGuard outer("outer.cpp", 1);
    const RealTimeGuard inner("inner.cpp", 2);
    careless_controller();
  });
  CHECK(ending.says("guarded at inner.cpp:2"));
}

TEST_CASE("a guard does not touch other threads") {
  const Ending ending = run_in_child([] {
    std::unique_ptr<int> block;
    std::thread other;
    {
      const RealTimeGuard guard;
      const RealTimeGuard::Pause pause;
      other = std::thread([&block] {
        for (int i = 0; i < 1000; ++i) block = std::make_unique<int>(i);
      });
    }
    {
      const RealTimeGuard guard;
      double sum = 0;
      for (int i = 0; i < 10'000; ++i) sum += std::sin(i);
      keep(&sum);
    }
    other.join();
    if (*block != 999) _exit(1);
  });
  CHECK(ending.exit_code == 0);
  CHECK(ending.words.empty());
}

TEST_CASE("a pause frees the thread for its scope, however deep, and no longer") {
  const Ending inside = run_in_child([] {
    const RealTimeGuard outer;
    const RealTimeGuard inner;
    const RealTimeGuard::Pause pause;
    careless_controller();
  });
  CHECK(inside.exit_code == 0);
  const Ending after = run_in_child([] {
    const RealTimeGuard outer;
    { const RealTimeGuard::Pause pause; }
    careless_controller();
  });
  CHECK(after.aborted);
}

TEST_CASE("a guard within a pause guards again") {
  const Ending ending = run_in_child([] {
    const RealTimeGuard outer("outer.cpp", 1);
    const RealTimeGuard::Pause pause;
    careless_controller();
    const RealTimeGuard again("again.cpp", 2);
    careless_controller();
  });
  CHECK(ending.aborted);
  CHECK(ending.says("guarded at again.cpp:2"));
}

TEST_CASE("a pause outside any guard changes nothing") {
  const RealTimeGuard::Pause pause;
  const auto block = std::make_unique<int>(1);
  CHECK(*block == 1);
}

}  // namespace
}  // namespace kadans::testing

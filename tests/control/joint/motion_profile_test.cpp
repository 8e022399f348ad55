#include "kadans/control/motion_profile.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"

namespace motion_profile_test {

using kadans::MotionProfile;
using kadans::RandomStream;
using kadans::SetpointState;

namespace {

constexpr double dt_s = 0.001;
constexpr double tolerance = 1e-9;  // relative to the limit

using Limits = MotionProfile::Limits;

// From rest to rest (Biagiotti and Melchiorri 2008, sec. 3.4).
double optimal_time_s(double way, const Limits& l) {
  const bool acceleration_reached = l.velocity * l.jerk >= l.acceleration * l.acceleration;
  const double rise_s =
      acceleration_reached ? l.acceleration / l.jerk + l.velocity / l.acceleration : 2 * std::sqrt(l.velocity / l.jerk);
  if (way >= l.velocity * rise_s) return way / l.velocity + rise_s;
  const double ramp_s = l.acceleration / l.jerk;
  if (way >= 2 * l.acceleration * ramp_s * ramp_s) {
    return ramp_s + 2 * std::sqrt(0.25 * ramp_s * ramp_s + way / l.acceleration);
  }
  return 4 * std::cbrt(0.5 * way / l.jerk);
}

Limits random_limits(RandomStream& random) {
  return {std::exp(random.uniform(-2, 2.5)), std::exp(random.uniform(0, 5)), std::exp(random.uniform(2, 9))};
}

// A state that can be kept within the limits: taking its acceleration back does not pass the velocity limit.
SetpointState random_state(RandomStream& random, const Limits& l) {
  const double acceleration = random.uniform(-1, 1) * std::min(l.acceleration, std::sqrt(2 * l.velocity * l.jerk));
  const double to_come = 0.5 * acceleration * std::abs(acceleration) / l.jerk;
  const double low = std::max(-l.velocity, -l.velocity - to_come), high = std::min(l.velocity, l.velocity - to_come);
  return {random.uniform(-3, 3), random.uniform(low, high), acceleration};
}

// Steps once and says whether velocity, acceleration and jerk kept to the limits.
bool step_within(MotionProfile& profile, const Limits& l, double dt = dt_s) {
  const SetpointState before = profile.state();
  const SetpointState& after = profile.step(dt);
  const double jerk = (after.acceleration - before.acceleration) / dt;
  return std::abs(after.velocity) <= l.velocity * (1 + tolerance) &&
         std::abs(after.acceleration) <= l.acceleration * (1 + tolerance) && std::abs(jerk) <= l.jerk * (1 + 1e-6) &&
         std::abs(after.value - before.value) <= l.velocity * dt * (1 + 1e-6) + 1e-12;
}

}  // namespace

TEST_CASE("MotionProfile from rest to rest takes the optimal time, keeps the limits and never turns back") {
  RandomStream random(1, "motion_profile");
  for (int i = 0; i < 500; ++i) {
    const Limits limits = random_limits(random);
    const double from = random.uniform(-3, 3), to = from + random.uniform(-1, 1) * std::exp(random.uniform(-8, 1));
    const double direction = to < from ? -1 : 1;
    MotionProfile profile;
    profile.reset(from);
    REQUIRE(profile.move(to, limits));
    REQUIRE(profile.remaining_s() == doctest::Approx(optimal_time_s(std::abs(to - from), limits)).epsilon(1e-6));
    bool within = true, forward = true, beyond = false;
    while (profile.remaining_s() > 0) {
      const double before = profile.state().value;
      within = within && step_within(profile, limits);
      forward = forward && direction * (profile.state().value - before) >= -1e-12;
      beyond = beyond || direction * (profile.state().value - to) > 1e-12;
    }
    CAPTURE(i);
    REQUIRE(within);
    REQUIRE(forward);
    REQUIRE_FALSE(beyond);
    REQUIRE(profile.state().value == to);
    REQUIRE(profile.state().velocity == 0);
  }
}

TEST_CASE("MotionProfile reaches any target from any state within the limits, continuously") {
  RandomStream random(2, "motion_profile");
  for (int i = 0; i < 1000; ++i) {
    const Limits limits = random_limits(random);
    const double to = random.uniform(-3, 3);
    MotionProfile profile;
    profile.set_state(random_state(random, limits));
    MotionProfile stopping = profile;
    stopping.stop(limits);
    REQUIRE(profile.move(to, limits));
    // Never later than who would stop first and go from there.
    const double by_stopping_s = stopping.remaining_s() + optimal_time_s(std::abs(to - stopping.target()), limits);
    REQUIRE(profile.remaining_s() <= by_stopping_s * (1 + 1e-6));
    bool within = true;
    int ticks = 0;
    for (; profile.remaining_s() > 0 && ticks < 2'000'000; ++ticks) within = within && step_within(profile, limits);
    CAPTURE(i);
    REQUIRE(within);
    REQUIRE(profile.state().value == to);
    REQUIRE(profile.state().acceleration == 0);
  }
}

TEST_CASE("MotionProfile keeps the limits while the target changes at random in each tick") {
  RandomStream random(3, "motion_profile");
  const Limits limits{2, 15, 400};
  MotionProfile profile;
  profile.reset(0);
  bool within = true;
  for (int i = 0; i < 20000; ++i) {
    if (random.uniform() < 0.3) (void)profile.move(random.uniform(-1, 1), limits);
    within = within && step_within(profile, limits);
  }
  CHECK(within);
  CHECK(profile.move(0.25, limits));
  while (profile.remaining_s() > 0) within = within && step_within(profile, limits);
  CHECK(within);
  CHECK(profile.state().value == 0.25);
}

TEST_CASE("MotionProfile planned anew in each tick for the same target takes the same way in the same time") {
  const Limits limits{2, 15, 400};
  MotionProfile once, again;
  once.set_state({0, -1, 3});
  again.set_state({0, -1, 3});
  REQUIRE(once.move(1.5, limits));
  double farthest = 0;
  int ticks = 0;
  for (; once.remaining_s() > 0; ++ticks) {
    (void)again.move(1.5, limits);
    farthest = std::max(farthest, std::abs(again.step(dt_s).value - once.step(dt_s).value));
  }
  CHECK(ticks > 500);
  CHECK(farthest < 1e-6);
  CHECK(again.state().value == doctest::Approx(1.5).epsilon(1e-9));
}

TEST_CASE("MotionProfile takes as long as it is told, or says that it cannot") {
  RandomStream random(4, "motion_profile");
  for (int i = 0; i < 300; ++i) {
    const Limits limits = random_limits(random);
    const double to = random.uniform(-3, 3);
    MotionProfile profile;
    profile.set_state(i % 2 == 0 ? SetpointState{} : random_state(random, limits));
    MotionProfile fastest = profile;
    REQUIRE(fastest.move(to, limits));
    const double duration_s = fastest.remaining_s() * random.uniform(1.01, 5);
    MotionProfile hurried = profile;
    CHECK_FALSE(hurried.move(to, limits, 0.9 * fastest.remaining_s()));
    CHECK(hurried.remaining_s() == fastest.remaining_s());
    REQUIRE(profile.move(to, limits, duration_s));
    CAPTURE(i);
    REQUIRE(profile.remaining_s() == doctest::Approx(duration_s).epsilon(1e-4));
    bool within = true;
    while (profile.remaining_s() > 0) within = within && step_within(profile, limits);
    REQUIRE(within);
    REQUIRE(profile.state().value == to);
  }
}

TEST_CASE("MotionProfile from beyond its limits comes inside and still arrives") {
  const Limits limits{1, 5, 100};
  MotionProfile profile;
  profile.set_state({0, 3, 20});
  REQUIRE(profile.move(0.5, limits));
  double fastest = 0;
  while (profile.remaining_s() > 0) {
    profile.step(dt_s);
    fastest = std::max(fastest, std::abs(profile.state().velocity));
  }
  CHECK(fastest < 3 + 0.5 * 20 * 20 / 100 + 0.01);  // the acceleration is taken back at once
  CHECK(profile.state().value == 0.5);
}

TEST_CASE("MotionProfile stops sooner than any motion to a target could") {
  const Limits limits{2, 15, 400};
  MotionProfile profile;
  profile.set_state({0, 1, 0});
  profile.stop(limits);
  CHECK(profile.remaining_s() == doctest::Approx(15.0 / 400 + 1 / 15.0));
  CHECK(profile.target() == doctest::Approx(0.5 * profile.remaining_s()));
  while (profile.remaining_s() > 0) profile.step(dt_s);
  CHECK(profile.state().value == profile.target());
}

TEST_CASE("MotionProfile told to go nowhere, or given no number, ends") {
  MotionProfile profile;
  profile.reset(0.3);
  CHECK(profile.move(0.3, {}));
  CHECK(profile.remaining_s() == 0);
  CHECK(profile.step(dt_s).value == 0.3);
  (void)profile.move(NAN, {});
  CHECK_FALSE(std::isfinite(profile.step(dt_s).value));
  profile.reset(0);
  CHECK(profile.step(dt_s).value == 0);
}

TEST_CASE("MotionProfile plans without allocating") {
  MotionProfile profile;
  profile.set_state({0, 0.3, 0.1});
  const kadans::testing::AllocationCount heap;
  (void)profile.move(1, {1, 10, 100}, 3);
  profile.step(dt_s);
  profile.stop({1, 10, 100});
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace motion_profile_test

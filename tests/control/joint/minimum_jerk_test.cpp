#include "kadans/control/minimum_jerk.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

namespace minimum_jerk_test {

using kadans::MinimumJerk;
using kadans::SetpointState;

namespace {

constexpr double dt_s = 0.001;

}  // namespace

TEST_CASE("MinimumJerk from rest to rest is the known polynomial") {
  MinimumJerk motion;
  motion.reset(1.0);
  motion.move(3.0, 2.0);
  for (int i = 1; i <= 2000; ++i) {
    const double tau = i * dt_s / 2.0;
    const double expected = 1.0 + 2.0 * tau * tau * tau * (10 - 15 * tau + 6 * tau * tau);
    REQUIRE(motion.step(dt_s).value == doctest::Approx(expected).epsilon(1e-6));
  }
  CHECK(motion.state().value == 3.0);
  CHECK(motion.state().velocity == 0.0);
  CHECK(motion.remaining_s() == 0.0);
}

TEST_CASE("MinimumJerk peaks at 1.875 times the mean velocity") {
  MinimumJerk motion;
  motion.reset(0);
  motion.move(1.0, 1.0);
  double fastest = 0;
  while (motion.remaining_s() > 0) fastest = std::max(fastest, motion.step(dt_s).velocity);
  CHECK(fastest == doctest::Approx(1.875).epsilon(1e-3));
}

TEST_CASE("MinimumJerk takes a new target without a step in position, velocity or acceleration") {
  MinimumJerk motion;
  motion.reset(0);
  motion.move(1.0, 1.0);
  for (int i = 0; i < 400; ++i) motion.step(dt_s);
  const SetpointState before = motion.state();
  motion.move(-0.5, 0.8);
  const SetpointState& after = motion.step(dt_s);
  CHECK(after.value == doctest::Approx(before.value + before.velocity * dt_s).epsilon(1e-3));
  CHECK(std::abs(after.velocity - before.velocity) < 0.01);
  CHECK(std::abs(after.acceleration - before.acceleration) < 0.5);
  while (motion.remaining_s() > 0) motion.step(dt_s);
  CHECK(motion.state().value == -0.5);
}

TEST_CASE("MinimumJerk of no duration is there at once") {
  MinimumJerk motion;
  motion.reset(0);
  motion.move(0.7, 0);
  CHECK(motion.step(dt_s).value == 0.7);
  CHECK(motion.remaining_s() == 0.0);
}

TEST_CASE("MinimumJerk stops on the way, forward of where it was told to") {
  MinimumJerk motion;
  motion.reset(0);
  motion.move(1.0, 1.0);
  for (int i = 0; i < 500; ++i) motion.step(dt_s);
  const double there = motion.state().value;
  motion.stop(0.1);
  double farthest = there;
  while (motion.remaining_s() > 0) farthest = std::max(farthest, motion.step(dt_s).value);
  CHECK(motion.state().value > there);
  CHECK(motion.state().value < there + 0.15);
  CHECK(farthest == doctest::Approx(motion.state().value));  // no turning back
  motion.stop(0.1);
  CHECK(motion.remaining_s() == 0.0);  // at rest there is nothing to stop
}

}  // namespace minimum_jerk_test

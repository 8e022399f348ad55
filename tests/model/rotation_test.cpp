// Quaternion arithmetic of kinematics.h.
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/signal/random.h"

using namespace kadans;

namespace {

void check_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(a[k] - b[k]) <= tolerance);
}

}  // namespace

TEST_CASE("A quarter turn about z takes x to y, its inverse y to x") {
  const Quat q = from_axis_angle({0, 0, 1}, M_PI / 2);
  check_near(rotate(q, {1, 0, 0}), {0, 1, 0});
  check_near(rotate_inverse(q, {0, 1, 0}), {1, 0, 0});
}

TEST_CASE("Roll, pitch and yaw turn about the fixed axes in this order") {
  // x, rolled by a quarter (stays), pitched by a quarter (down), yawed (stays down).
  check_near(rotate(from_roll_pitch_yaw(M_PI / 2, M_PI / 2, M_PI / 2), {1, 0, 0}), {0, 0, -1});
  // y, rolled up to z, pitched to x, yawed to y.
  check_near(rotate(from_roll_pitch_yaw(M_PI / 2, M_PI / 2, M_PI / 2), {0, 1, 0}), {0, 1, 0});
}

TEST_CASE("Roll, pitch and yaw come back out of the quaternion") {
  RandomStream random(7, "rotation test");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 rpy{random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5), random.uniform(-3.1, 3.1)};
    check_near(roll_pitch_yaw(from_roll_pitch_yaw(rpy[0], rpy[1], rpy[2])), rpy, 1e-9);
  }
}

TEST_CASE("Looking straight down, roll is 0 and the rotation is still the same") {
  const Quat q = from_axis_angle({0, 1, 0}, M_PI / 2);
  for (const double yaw : {0.0, 0.7, -2.0}) {
    const Quat turned = multiply(from_axis_angle({0, 0, 1}, yaw), q);
    const Vec3 rpy = roll_pitch_yaw(turned);
    CHECK(rpy[1] == doctest::Approx(M_PI / 2));
    const Quat again = from_roll_pitch_yaw(rpy[0], rpy[1], rpy[2]);
    check_near(rotate(again, {0, 1, 0}), rotate(turned, {0, 1, 0}), 1e-7);
    check_near(rotate(again, {1, 0, 0}), rotate(turned, {1, 0, 0}), 1e-7);
  }
}

TEST_CASE("Composed poses move a point as one after the other") {
  const Pose a{{1, 2, 3}, from_roll_pitch_yaw(0.1, 0.2, 0.3)}, b{{-4, 5, 6}, from_roll_pitch_yaw(-1, 0.5, 2)};
  check_near(transform(compose(a, b), {7, 8, 9}), transform(a, transform(b, {7, 8, 9})));
}

TEST_CASE("A quaternion without length becomes the identity, any other gets the length 1") {
  CHECK(normalized({0, 0, 0, 0}) == Quat{1, 0, 0, 0});
  CHECK(normalized({2, 0, 0, 0}) == Quat{1, 0, 0, 0});
  CHECK(normalized({0, 3, 0, 4}) == Quat{0, 0.6, 0, 0.8});
}

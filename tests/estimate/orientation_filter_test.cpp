#include "estimate/orientation_filter.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"

namespace orientation_filter_test {

using kadans::from_axis_angle;
using kadans::from_roll_pitch_yaw;
using kadans::OrientationFilter;
using kadans::Quat;
using kadans::roll_pitch_yaw;
using kadans::rotate_inverse;
using kadans::Vec3;

namespace {

constexpr double dt_s = 0.001;

Vec3 at_rest(const Quat& orientation) { return rotate_inverse(orientation, {0, 0, 9.81}); }

double angle_between_rad(const Quat& a, const Quat& b) {
  const Quat d = kadans::multiply(kadans::conjugate(a), b);
  return 2 * std::atan2(std::sqrt(d[1] * d[1] + d[2] * d[2] + d[3] * d[3]), std::fabs(d[0]));
}

void run(OrientationFilter& filter, double duration_s, const Vec3& gyro_rad_s, const Vec3& force_m_s2) {
  const int ticks = static_cast<int>(std::lround(duration_s / dt_s));
  for (int n = 0; n < ticks; ++n) filter.update(gyro_rad_s, force_m_s2, dt_s);
}

}  // namespace

TEST_CASE("The first specific force sets roll and pitch at once, and yaw to 0") {
  for (const double roll_rad : {-2.8, -0.3, 0.0, 1.2})
    for (const double pitch_rad : {-1.5, -0.4, 0.0, 0.9}) {
      OrientationFilter filter({});
      filter.update({}, at_rest(from_roll_pitch_yaw(roll_rad, pitch_rad, 2.0)), dt_s);
      CHECK(angle_between_rad(filter.state().orientation, from_roll_pitch_yaw(roll_rad, pitch_rad, 0)) < 1e-9);
    }
}

TEST_CASE("Before it has felt gravity the orientation is the identity") {
  OrientationFilter filter({});
  run(filter, 0.1, {1, 0, 0}, {0, 0, 0.1});
  CHECK_FALSE(filter.state().initialised);
  CHECK(filter.state().orientation == Quat{1, 0, 0, 0});
  filter.update({}, {0, 9.81, 0}, dt_s);
  CHECK(filter.state().initialised);
  CHECK(roll_pitch_yaw(filter.state().orientation)[0] == doctest::Approx(std::numbers::pi / 2));
}

TEST_CASE("A wrong tilt is corrected by gravity at the rate of the accelerometer's gain") {
  OrientationFilter filter({.accelerometer_gain_per_s = 0.5, .gyro_bias_gain_per_s2 = 0});
  filter.update({}, at_rest(from_roll_pitch_yaw(0, 0.1, 0)), dt_s);
  run(filter, 2, {}, {0, 0, 9.81});
  CHECK(roll_pitch_yaw(filter.state().orientation)[1] == doctest::Approx(0.1 * std::exp(-0.5 * 2)).epsilon(0.01));
}

TEST_CASE("A constant rotation about a slanted axis is followed without error") {
  OrientationFilter filter({});
  const Vec3 axis{2.0 / 7, 3.0 / 7, 6.0 / 7};
  double worst_rad = 0;
  for (int n = 0; n <= 10000; ++n) {
    const Quat truth = from_axis_angle(axis, 2.0 * n * dt_s);
    filter.update({2 * axis[0], 2 * axis[1], 2 * axis[2]}, at_rest(truth), dt_s);
    worst_rad = std::max(worst_rad, angle_between_rad(filter.state().orientation, truth));
  }
  CHECK(worst_rad < 1e-9);
}

TEST_CASE("Coarse steps turn by the true angle too") {
  OrientationFilter filter({.accelerometer_gain_per_s = 0, .gyro_bias_gain_per_s2 = 0});
  filter.update({0, 0, 3}, {0, 0, 9.81}, 0.1);
  for (int n = 0; n < 10; ++n) filter.update({0, 0, 3}, {0, 0, 9.81}, 0.1);
  CHECK(roll_pitch_yaw(filter.state().orientation)[2] == doctest::Approx(3));
}

TEST_CASE("The gyro's bias about level axes is learnt, about the vertical it cannot be") {
  OrientationFilter filter({});
  run(filter, 60, {0.02, -0.01, 0.015}, {0, 0, 9.81});
  const OrientationFilter::State& state = filter.state();
  CHECK(state.gyro_bias_rad_s[0] == doctest::Approx(0.02).epsilon(0.01));
  CHECK(state.gyro_bias_rad_s[1] == doctest::Approx(-0.01).epsilon(0.01));
  CHECK(std::fabs(state.gyro_bias_rad_s[2]) < 1e-3);
  CHECK(std::fabs(state.angular_velocity_rad_s[0]) < 3e-4);
  CHECK(kadans::roll_pitch_yaw(state.orientation)[0] == doctest::Approx(0).epsilon(1e-3));
  CHECK_FALSE(state.gyro_bias_saturated);
}

TEST_CASE("A bias beyond its maximum is learnt up to it, and said") {
  OrientationFilter filter({.gyro_bias_max_rad_s = 0.05});
  run(filter, 60, {0.2, 0, 0}, {0, 0, 9.81});
  CHECK(filter.state().gyro_bias_rad_s[0] == 0.05);
  CHECK(filter.state().gyro_bias_saturated);
}

TEST_CASE("In free fall and on impact the accelerometer has no say") {
  OrientationFilter filter({});
  filter.update({}, {0, 0, 9.81}, dt_s);
  for (const Vec3& force_m_s2 : {Vec3{0, 0, 0}, Vec3{0.2, 0, 0.1}, Vec3{15, 0, 9.81}, Vec3{0, 40, 0}}) {
    run(filter, 1, {}, force_m_s2);
    CHECK(filter.state().gravity_weight == 0);
    CHECK(angle_between_rad(filter.state().orientation, {1, 0, 0, 0}) < 1e-12);
  }
  filter.update({}, {0, 0, 9.81 * 1.1}, dt_s);
  CHECK(filter.state().gravity_weight == doctest::Approx(0.5));
}

TEST_CASE("Readings that are not finite do not enter the orientation") {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  OrientationFilter filter({});
  filter.update({}, {0, 0, nan}, dt_s);
  CHECK_FALSE(filter.state().initialised);
  filter.update({}, {0, 0, 9.81}, dt_s);
  filter.update({nan, 0, 0}, {0, 0, 9.81}, dt_s);
  filter.update({0, infinity, 0}, {0, 0, 9.81}, dt_s);
  filter.update({1, 0, 0}, {0, 0, 9.81}, nan);
  CHECK(filter.state().orientation == Quat{1, 0, 0, 0});
  filter.update({}, {0, infinity, 9.81}, dt_s);
  filter.update({}, {nan, 0, 9.81}, dt_s);
  CHECK(filter.state().gravity_weight == 0);
  CHECK(filter.state().orientation == Quat{1, 0, 0, 0});
}

TEST_CASE("Gains that are negative or not finite are refused by name") {
  using Config = OrientationFilter::Config;
  CHECK_THROWS_WITH_AS(OrientationFilter(Config{.accelerometer_gain_per_s = -1}),
                       "accelerometer_gain_per_s = -1.000000 must be >= 0", std::invalid_argument);
  CHECK_THROWS_WITH_AS(OrientationFilter(Config{.gyro_bias_gain_per_s2 = std::nan("")}),
                       "gyro_bias_gain_per_s2 = nan must be >= 0", std::invalid_argument);
  CHECK_THROWS_AS(OrientationFilter(Config{.gravity_tolerance = 0}), std::invalid_argument);
  CHECK_THROWS_AS(OrientationFilter(Config{.gyro_bias_max_rad_s = -0.1}), std::invalid_argument);
}

}  // namespace orientation_filter_test

#include "estimate/odometry.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"

using namespace kadans;
using namespace kadans::test;

namespace {

constexpr double tick_s = 0.001;

// A base on one foot or two, by the odometry alone.
struct Ground {
  Odometry odometry;
  OdometryStatus status;
  BaseStatus base;
  bool all = true;
  double drift_rad_s = 0;  // of the gyro about the vertical

  void go(double x_m, double y_m, double for_s, double turn_rad_s = 0) {
    const long ticks = std::lround(for_s / tick_s);
    for (long i = 0; i < ticks; ++i) {
      base.yaw_rad = std::remainder(base.yaw_rad + (turn_rad_s + drift_rad_s) * tick_s, 2 * std::numbers::pi);
      base.angular_velocity_rad_s[2] = turn_rad_s + drift_rad_s;
      const double c = std::cos(base.yaw_rad), s = std::sin(base.yaw_rad);
      const double ahead_m = x_m / static_cast<double>(ticks), left_m = y_m / static_cast<double>(ticks);
      Odometry::Way way;
      way.add(100, c * ahead_m - s * left_m, s * ahead_m + c * left_m, drift_rad_s * tick_s);
      odometry.update(way, all, {c, s}, base, tick_s, status);
    }
  }
  void fly(double for_s) {
    for (double t_s = 0; t_s < for_s - tick_s / 2; t_s += tick_s)
      odometry.update({}, false, {std::cos(base.yaw_rad), std::sin(base.yaw_rad)}, base, tick_s, status);
  }
};

}  // namespace

TEST_CASE("Odometry adds the way along the heading, which turns with the gyro, beyond half a turn too") {
  Ground ground;
  ground.go(1, 0.2, 1);
  CHECK(ground.status.valid);
  CHECK(ground.status.x_m == doctest::Approx(1));
  CHECK(ground.status.y_m == doctest::Approx(0.2));
  ground.go(0, 0, 1, 1.5 * std::numbers::pi);
  CHECK(ground.status.heading_rad == doctest::Approx(-0.5 * std::numbers::pi).epsilon(1e-6));
  ground.go(0, 1, 1);  // to its left, which is forward of where it began
  CHECK(ground.status.x_m == doctest::Approx(2).epsilon(1e-6));
  CHECK(ground.status.y_m == doctest::Approx(0.2).epsilon(1e-6));
}

TEST_CASE("a reset of the odometry puts place and heading to 0 where the base is then") {
  Ground ground;
  ground.go(1, 0, 1, 0.5);
  ground.odometry.reset();
  ground.go(0, 0, tick_s);
  CHECK(ground.status.x_m == 0);
  CHECK(ground.status.heading_rad == 0);
  CHECK(ground.status.resets == 1);
  ground.go(1, 0, 1);
  CHECK(ground.status.x_m == doctest::Approx(1));
  CHECK(ground.status.y_m == doctest::Approx(0));
}

TEST_CASE("the path of the odometry goes on over a reset, and counts where its way was lost") {
  Ground ground;
  ground.go(1, 0, 1, 0.5 * std::numbers::pi);
  const double x_m = ground.status.path_x_m, y_m = ground.status.path_y_m;
  CHECK(x_m == ground.status.x_m);
  ground.odometry.reset();
  ground.go(0, 0, tick_s);
  CHECK(ground.status.x_m == 0);
  CHECK(ground.status.path_x_m == doctest::Approx(x_m));
  CHECK(ground.status.path_heading_rad == doctest::Approx(0.5 * std::numbers::pi).epsilon(1e-6));
  ground.go(1, 0, 1);
  CHECK(ground.status.path_x_m == doctest::Approx(x_m).epsilon(1e-6));
  CHECK(ground.status.path_y_m == doctest::Approx(y_m + 1).epsilon(1e-6));
  CHECK(ground.status.breaks == 0);
  ground.fly(0.2);
  CHECK(ground.status.breaks == 1);
  ground.odometry.reset();
  ground.go(0, 0, 1);
  CHECK(ground.status.breaks == 2);
}

TEST_CASE("odometry of a robot that is lifted or lies is not valid until it is reset") {
  Ground ground;
  ground.go(1, 0, 1);
  ground.fly(0.05);
  ground.go(1, 0, 1);
  CHECK(ground.status.valid);
  CHECK(ground.status.x_m == doctest::Approx(2));
  SUBCASE("lifted") { ground.fly(0.11); }
  SUBCASE("lies") {
    ground.base.posture = Posture::prone;
    ground.go(1, 0, 0.01);
    ground.base.posture = Posture::upright;
  }
  CHECK_FALSE(ground.status.valid);
  ground.go(1, 0, 1, 0.1);
  CHECK_FALSE(ground.status.valid);
  ground.odometry.reset();
  ground.fly(tick_s);
  ground.go(1, 0, 1);
  CHECK(ground.status.valid);
  CHECK(ground.status.x_m == doctest::Approx(1));
}

TEST_CASE("odometry learns the gyro's drift while the robot stands, and takes it from the heading afterwards") {
  Ground ground;
  ground.drift_rad_s = 0.02;
  ground.go(0, 0, 2);
  ground.odometry.reset();
  ground.all = false;  // it walks
  ground.go(10, 0, 20);
  CHECK(std::abs(ground.status.heading_rad) < 0.002);  // 0.4 with the drift
  CHECK(std::abs(ground.status.y_m) < 0.02);
  CHECK(ground.status.x_m == doctest::Approx(10).epsilon(0.001));
}

TEST_CASE("a foot that tips carries the base on by the point about which it tips, not by its frame") {
  TulipFixture robot;
  for (FootSample& foot : robot.sensors.feet) foot.force_N = {0, 0, 34, 34};  // on its toes
  const auto from_base_m = [&](const Vec3& in_foot_m) {
    Kinematics kinematics(tulip());
    std::vector<double> position_rad;
    for (std::size_t i = 0; i < tulip().joints.size(); ++i)
      position_rad.push_back(robot.sensors.joints[i].position_rad);
    kinematics.update(position_rad, {{0, 0, 0}, {1, 0, 0, 0}});
    return transform(kinematics.link(tulip().find_link("l_ankle_roll_link").value()), in_foot_m)[0];
  };
  const Vec3 tip_m{0.14, 0, -0.06};
  const double tip_was_m = from_base_m(tip_m), frame_was_m = from_base_m({0, 0, 0});
  robot.advance();
  for (int i = 0; i < 100; ++i) {
    for (const char* hip : {"l_hip_pitch", "r_hip_pitch"}) robot.sensors.joints[joint_of(hip)].position_rad += 0.001;
    robot.advance();
  }
  const double way_m = tip_was_m - from_base_m(tip_m);
  CHECK(robot.status.odometry.valid);
  CHECK(robot.status.odometry.x_m == doctest::Approx(way_m).epsilon(1e-6));
  CHECK(std::abs(way_m - (frame_was_m - from_base_m({0, 0, 0}))) > 0.005);
  CHECK(std::abs(robot.status.odometry.y_m) < 1e-9);
}

TEST_CASE("a robot without feet has no odometry") {
  TulipFixture robot(EstimateSettings{});
  robot.sensors.foot_count = 0;
  for (int i = 0; i < 200; ++i) robot.advance();
  CHECK_FALSE(robot.status.odometry.valid);
}

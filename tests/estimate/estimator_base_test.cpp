#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"

using namespace kadans;
using kadans::test::joint_of;
using kadans::test::TulipFixture;

namespace {

void bend_leg(TulipFixture& robot, const std::string& side, double angle_rad) {
  robot.sensors.joints[joint_of((side + "_hip_pitch").c_str())].position_rad = -angle_rad;
  robot.sensors.joints[joint_of((side + "_knee").c_str())].position_rad = 2 * angle_rad;
  robot.sensors.joints[joint_of((side + "_ankle_pitch").c_str())].position_rad = -angle_rad;
}

double height_bent_m(double angle_rad) { return 0.868 - 0.55 * (1 - std::cos(angle_rad)); }

}  // namespace

TEST_CASE("Height of a standing and of a squatting robot is known through its legs") {
  TulipFixture robot;
  robot.advance();
  CHECK(robot.status.base.height_m == doctest::Approx(0.868));
  bend_leg(robot, "l", 0.6);
  bend_leg(robot, "r", 0.6);
  robot.advance();
  CHECK(robot.status.base.height_m == doctest::Approx(height_bent_m(0.6)));
}

TEST_CASE("Only the feet that bear count, the lowest of them, and without any the height holds") {
  TulipFixture robot;
  bend_leg(robot, "l", 0.6);
  robot.advance();
  CHECK(robot.status.base.height_m == doctest::Approx(0.868));
  robot.sensors.feet[1].force_N.fill(0);
  robot.advance();
  CHECK(robot.status.feet[0].contact);
  CHECK_FALSE(robot.status.feet[1].contact);
  CHECK(robot.status.base.height_m == doctest::Approx(height_bent_m(0.6)));
  robot.sensors.feet[0].force_N.fill(0);
  bend_leg(robot, "l", 0);
  robot.advance();
  CHECK(robot.status.base.height_m == doctest::Approx(height_bent_m(0.6)));
  CHECK(robot.status.support.force_N == 0);
}

TEST_CASE("A leaning robot's height is over the lowest corner of its sole, along the true vertical") {
  TulipFixture robot;
  const Quat lean = from_roll_pitch_yaw(0.1, 0.3, 0);
  robot.sensors.imu.acceleration_m_s2 = rotate_inverse(lean, {0, 0, 9.81});
  robot.advance();
  const EstimateSettings settings = test::tulip_settings();
  double lowest_m = 0;
  for (const double side_m : {0.085, -0.085})
    for (const Vec3& corner_m : settings.feet[0].sensors_m)
      lowest_m = std::min(lowest_m, rotate(lean, {corner_m[0], corner_m[1] + side_m, -0.868})[2]);
  CHECK(robot.status.base.height_m == doctest::Approx(-lowest_m));
  CHECK(robot.status.base.roll_rad == doctest::Approx(0.1));
  CHECK(robot.status.base.pitch_rad == doctest::Approx(0.3));
  CHECK(robot.status.base.tilt_rad == doctest::Approx(std::acos(std::cos(0.1) * std::cos(0.3))));
}

TEST_CASE("Lying down is a tilt of a quarter turn, hanging upside down of half a turn") {
  const double half_pi = std::numbers::pi / 2;
  TulipFixture prone, upside_down;
  prone.sensors.imu.acceleration_m_s2 = {-9.81, 0, 0};
  prone.advance();
  CHECK(prone.status.base.tilt_rad == doctest::Approx(half_pi));
  CHECK(prone.status.base.pitch_rad == doctest::Approx(half_pi));
  upside_down.sensors.imu.acceleration_m_s2 = {0, 0, -9.81};
  upside_down.advance();
  CHECK(upside_down.status.base.tilt_rad == doctest::Approx(2 * half_pi));
}

TEST_CASE("A turn on the spot shows as yaw and as rate, and moves nothing in the heading frame") {
  TulipFixture robot;
  robot.sensors.imu.angular_velocity_rad_s = {0, 0, 1.2};
  robot.sensors.feet[0].force_N = {0, 0, 30, 30};
  robot.sensors.feet[1].force_N = {60, 60, 0, 0};
  for (int n = 0; n <= 1000; ++n) {
    robot.advance();
    REQUIRE(robot.status.support.force_N == doctest::Approx(180));
    REQUIRE(robot.status.support.cop_x_m == doctest::Approx((60 * 0.14 - 120 * 0.08) / 180));
    REQUIRE(robot.status.support.cop_y_m == doctest::Approx((60 * 0.085 - 120 * 0.085) / 180));
  }
  CHECK(robot.status.base.yaw_rad == doctest::Approx(1.2));
  CHECK(robot.status.base.angular_velocity_rad_s[2] == doctest::Approx(1.2));
  CHECK(robot.status.feet[0].cop_x_m == doctest::Approx(0.14));
  CHECK(robot.status.feet[1].cop_x_m == doctest::Approx(-0.08));
  CHECK(robot.status.feet[0].cop_y_m == doctest::Approx(0));
}

TEST_CASE("An IMU that is read in every tenth tick gives the same angle in the end") {
  TulipFixture robot;
  robot.sensors.imu.angular_velocity_rad_s = {0, 0, 2};
  for (int n = 0; n <= 1000; ++n) {
    if (n % 10 == 0) ++robot.sensors.imu.sequence;
    robot.advance_in_silence();
  }
  CHECK(robot.status.base.yaw_rad == doctest::Approx(2));
}

TEST_CASE("What an IMU says that is not finite is not used, and said") {
  TulipFixture robot;
  robot.sensors.imu.angular_velocity_rad_s = {0, 0, 1};
  for (int n = 0; n <= 300; ++n) {
    const bool gyro_broken = n >= 100 && n < 150, force_broken = n >= 200 && n < 250;
    robot.sensors.imu.angular_velocity_rad_s[0] = gyro_broken ? std::nan("") : 0;
    robot.sensors.imu.acceleration_m_s2[1] = force_broken ? std::numeric_limits<double>::infinity() : 0;
    robot.advance();
    REQUIRE(robot.estimator.health().imu.finite == !(gyro_broken || force_broken));
    REQUIRE(robot.estimator.health().imu.silent_ticks == 0);
    if (gyro_broken) REQUIRE(robot.status.base.yaw_rad == doctest::Approx(0.099));
  }
  CHECK(robot.status.base.yaw_rad == doctest::Approx(0.3));
  CHECK(robot.status.base.tilt_rad == doctest::Approx(0));
}

TEST_CASE("A pressure sensor that is not finite keeps its last value, and is said") {
  TulipFixture robot;
  robot.advance();
  robot.sensors.feet[0].force_N = {std::nan(""), 17, 17, 3};
  robot.advance();
  CHECK(robot.status.feet[0].force_N == doctest::Approx(17 * 3 + 3));
  CHECK_FALSE(robot.estimator.health().feet[0].finite);
  CHECK(robot.estimator.health().feet[1].finite);
}

TEST_CASE("A tick without a sane dt counts as one of nominal length") {
  TulipFixture robot;
  robot.sensors.imu.angular_velocity_rad_s = {0, 0, 1};
  for (const double wrong_s : {0.001, std::nan(""), 0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    robot.dt_s = wrong_s;
    robot.advance();
  }
  CHECK(robot.status.base.yaw_rad == doctest::Approx(0.004));
}

TEST_CASE("A copy goes on as its original") {
  TulipFixture robot;
  const auto shake = [&robot](int n) {
    for (std::size_t i = 0; i < 14; ++i)
      robot.sensors.joints[i].position_rad = 0.1 * std::sin(0.01 * n + static_cast<double>(i));
    robot.sensors.imu.angular_velocity_rad_s = {0.1, 0.2 * std::sin(0.02 * n), 0.3};
    robot.advance();
  };
  for (int n = 0; n < 100; ++n) shake(n);
  TulipFixture copy = robot;
  for (int n = 100; n < 200; ++n) shake(n);
  std::swap(copy, robot);
  for (int n = 100; n < 200; ++n) shake(n);
  for (std::size_t i = 0; i < 14; ++i)
    CHECK(robot.joints.joints[i].velocity_rad_s == copy.joints.joints[i].velocity_rad_s);
  CHECK(robot.status.base.orientation == copy.status.base.orientation);
  CHECK(robot.status.base.height_m == copy.status.base.height_m);
}

TEST_CASE("The posture is the side that the trunk lies on, also where roll and yaw cannot be told apart") {
  struct Row {
    Vec3 up;  // in the base frame: what the accelerometer says at rest, over g
    Posture posture;
  };
  for (const Row& row : {Row{{-0.2, 0.1, 0.97}, Posture::upright},
                         {{-0.997, 0, 0.07}, Posture::prone},
                         {{-0.997, 0.04, -0.06}, Posture::prone},
                         {{0.997, 0, 0.07}, Posture::supine},
                         {{0, -0.997, 0.07}, Posture::left},
                         {{0, 0.997, 0.07}, Posture::right},
                         {{0, 0.8, 0.59}, Posture::right},
                         {{0, 0.79, 0.61}, Posture::upright}}) {
    TulipFixture robot;
    robot.sensors.imu.acceleration_m_s2 = {9.81 * row.up[0], 9.81 * row.up[1], 9.81 * row.up[2]};
    robot.advance();
    CAPTURE(row.up[0]);
    CAPTURE(row.up[1]);
    CHECK(robot.status.base.posture == row.posture);
  }
}

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"

using namespace kadans;
using kadans::test::joint_of;
using kadans::test::tulip_settings;
using kadans::test::TulipFixture;

TEST_CASE("A joint that turns evenly shows its position and its velocity") {
  TulipFixture robot;
  const std::size_t knee = joint_of("l_knee");
  for (int n = 0; n < 200; ++n) {
    robot.sensors.joints[knee].position_rad = 0.5 + 2 * n * 0.001;
    robot.advance();
  }
  CHECK(robot.joints.count == 14);
  CHECK(robot.joints.joints[knee].position_rad == 0.5 + 2 * 199 * 0.001);
  CHECK(robot.joints.joints[knee].velocity_rad_s == doctest::Approx(2));
  CHECK(robot.joints.joints[joint_of("r_knee")].velocity_rad_s == 0);
}

TEST_CASE("Effort is the spring's torque where there is a spring, else the motor's") {
  EstimateSettings settings = tulip_settings();
  settings.spring_Nm_per_rad.assign(14, 0);
  const std::size_t sprung = joint_of("l_knee"), stiff = joint_of("l_hip_yaw");
  settings.spring_Nm_per_rad[sprung] = 200;
  TulipFixture robot(settings);
  for (const std::size_t joint : {sprung, stiff})
    robot.sensors.joints[joint] = {
        .position_rad = 0.3, .motor_position_rad = 0.35, .motor_effort_Nm = 7, .sequence = 0};
  robot.advance();
  CHECK(robot.joints.joints[sprung].effort_Nm == doctest::Approx(200 * 0.05));
  CHECK(robot.joints.joints[stiff].effort_Nm == 7);
}

TEST_CASE("Efforts of coupled joints are those of the springs of their drives, and of the motor that has none") {
  RobotModel model = kadans::test::tulip();
  const std::size_t tilt = joint_of("l_ankle_pitch"), roll = joint_of("l_ankle_roll");
  model.transmissions.emplace_back(
      Transmission::Settings{.kind = Transmission::Kind::differential, .joints = {tilt, roll}});
  EstimateSettings settings = tulip_settings();
  settings.spring_Nm_per_rad.assign(14, 0);
  settings.spring_Nm_per_rad[tilt] = 200;
  settings.spring_Nm_per_rad[roll] = 80;
  const auto efforts = [&] {
    Estimator estimator(model, settings, 0.001);
    SensorFrame sensors;
    sensors.joint_count = 14;
    sensors.joints[tilt] = {.position_rad = 0.3, .motor_position_rad = 0.35, .motor_effort_Nm = 7, .sequence = 1};
    sensors.joints[roll] = {.position_rad = 0.1, .motor_position_rad = 0.12, .motor_effort_Nm = 3, .sequence = 1};
    JointStates joints;
    RobotStatus status;
    estimator.update(sensors, 0.001, 0, joints, status);
    return std::array{joints.joints[tilt].effort_Nm, joints.joints[roll].effort_Nm};
  };
  const double left_Nm = 200 * (0.05 + 0.02), right_Nm = 80 * (0.05 - 0.02);
  CHECK(efforts()[0] == doctest::Approx(left_Nm + right_Nm));
  CHECK(efforts()[1] == doctest::Approx(left_Nm - right_Nm));
  settings.spring_Nm_per_rad[roll] = 0;
  const double motor_Nm = 0.5 * (7 - 3);  // of the right drive
  CHECK(efforts()[0] == doctest::Approx(left_Nm + motor_Nm));
  CHECK(efforts()[1] == doctest::Approx(left_Nm - motor_Nm));
}

TEST_CASE("A slower joint is looked at in every n-th tick only, and its velocity is right all the same") {
  EstimateSettings settings = tulip_settings();
  settings.sample_divisor.assign(14, 1);
  const std::size_t slow = joint_of("r_knee"), fast = joint_of("l_knee");
  settings.sample_divisor[slow] = 10;
  settings.joint_velocity_cutoff_Hz.assign(14, 0);
  settings.joint_velocity_cutoff_Hz[slow] = 20;
  TulipFixture robot(settings);
  robot.tick = 1003;  // the first tick looks at everything, wherever the count stands
  double seen_rad = -1;
  for (std::uint32_t n = 0; n < 500; ++n) {
    const double position_rad = 1 + 0.003 * n;
    robot.sensors.joints[slow].position_rad = robot.sensors.joints[fast].position_rad = position_rad;
    const std::uint64_t tick = robot.tick;
    robot.advance();
    if (tick % 10 == 0 || n == 0) seen_rad = position_rad;
    REQUIRE(robot.joints.joints[slow].position_rad == seen_rad);
    REQUIRE(robot.joints.joints[fast].position_rad == position_rad);
    REQUIRE(robot.estimator.health().joints[slow].silent_ticks == (n < 7 ? n : tick % 10));
  }
  CHECK(robot.joints.joints[slow].velocity_rad_s == doctest::Approx(3));
  CHECK(robot.joints.joints[fast].velocity_rad_s == doctest::Approx(3));
  CHECK(robot.estimator.health().joints[slow].period_ticks == 10);
  CHECK(robot.estimator.health().joints[fast].period_ticks == 1);
}

TEST_CASE("Without new readings a joint holds and its silence is counted") {
  TulipFixture robot;
  for (int n = 0; n < 100; ++n) {
    for (JointSample& joint : robot.sensors.joints) joint.position_rad = 0.004 * n;
    robot.advance();
  }
  const JointState before = robot.joints.joints[5];
  for (JointSample& joint : robot.sensors.joints) joint.position_rad = 9;  // not a new reading: the sequence stands
  for (std::uint32_t n = 1; n <= 7; ++n) {
    robot.advance_in_silence();
    CHECK(robot.estimator.health().joints[5].silent_ticks == n);
    CHECK(robot.estimator.health().imu.silent_ticks == n);
    CHECK(robot.estimator.health().feet[1].silent_ticks == n);
  }
  CHECK(robot.joints.joints[5].position_rad == before.position_rad);
  CHECK(robot.joints.joints[5].velocity_rad_s == before.velocity_rad_s);
  for (JointSample& joint : robot.sensors.joints) joint.position_rad = 0.004 * 107;  // it went on evenly meanwhile
  robot.advance();
  CHECK(robot.joints.joints[5].velocity_rad_s == doctest::Approx(4));
  CHECK(robot.estimator.health().joints[5].silent_ticks == 0);
}

TEST_CASE("A position that is not finite is not used, said, and forgotten with the next good one") {
  for (const double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    TulipFixture robot;
    for (int n = 0; n < 120; ++n) {
      const bool broken = n >= 100 && n < 110;
      robot.sensors.joints[3].position_rad = broken ? wrong : 0.004 * n;
      robot.advance();
      REQUIRE(robot.estimator.health().joints[3].finite == !broken);
      REQUIRE(robot.estimator.health().joints[4].finite);
      REQUIRE(robot.joints.joints[3].position_rad == 0.004 * (broken ? 99 : n));
      if (n > 50) REQUIRE(robot.joints.joints[3].velocity_rad_s == doctest::Approx(4));
    }
  }
}

TEST_CASE("A motor's reading that is not finite leaves effort as it was, and position in use") {
  EstimateSettings settings = tulip_settings();
  settings.spring_Nm_per_rad.assign(14, 0);
  settings.spring_Nm_per_rad[3] = 100;
  TulipFixture robot(settings);
  robot.sensors.joints[3].motor_position_rad = 0.1;
  robot.sensors.joints[4].motor_effort_Nm = 5;
  robot.advance();
  robot.sensors.joints[3].motor_position_rad = std::nan("");
  robot.sensors.joints[4].motor_effort_Nm = std::nan("");
  robot.sensors.joints[3].position_rad = robot.sensors.joints[4].position_rad = 0.02;
  robot.advance();
  CHECK(robot.joints.joints[3].effort_Nm == doctest::Approx(10));
  CHECK(robot.joints.joints[4].effort_Nm == 5);
  CHECK(robot.joints.joints[3].position_rad == 0.02);
  CHECK_FALSE(robot.estimator.health().joints[3].finite);
  CHECK_FALSE(robot.estimator.health().joints[4].finite);
}

TEST_CASE("Joints that the frame does not have are silent from the start") {
  TulipFixture robot;
  robot.sensors.joint_count = 10;
  for (int n = 0; n < 5; ++n) robot.advance();
  CHECK(robot.joints.count == 14);
  CHECK(robot.estimator.health().joints[9].silent_ticks == 0);
  CHECK(robot.estimator.health().joints[10].silent_ticks == 5);
}

TEST_CASE("A reading that says when it was taken gives the velocity by its own times") {
  TulipFixture timed, untimed;
  const std::size_t knee = joint_of("l_knee");
  double worst_timed = 0, worst_untimed = 0;
  for (int n = 1; n < 400; ++n) {
    const std::int64_t time_ns = 1'000'000LL * n + (n * 7919 % 11 - 5) * 60'000LL;  // a bus that jitters by 0.3 ms
    for (TulipFixture* robot : {&timed, &untimed}) {
      JointSample& sample = robot->sensors.joints[knee];
      sample.position_rad = 2e-9 * static_cast<double>(time_ns);
      sample.time_ns = robot == &timed ? time_ns : 0;
      robot->advance();
    }
    if (n < 100) continue;
    worst_timed = std::max(worst_timed, std::abs(timed.joints.joints[knee].velocity_rad_s - 2));
    worst_untimed = std::max(worst_untimed, std::abs(untimed.joints.joints[knee].velocity_rad_s - 2));
  }
  CHECK(worst_timed < 1e-9);
  CHECK(worst_untimed > 0.05);
}

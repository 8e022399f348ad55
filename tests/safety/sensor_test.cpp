// Sensors that fail, of joints, IMU and feet: when it is found, and what is no fault.
#include <doctest/doctest.h>

#include "bench.h"
#include "safety/detection.h"

namespace sensor_test {

using namespace kadans;
using namespace kadans::safety_bench;

namespace {

int promised(FaultCode code) { return static_cast<int>(detection_ticks(code, settings(), dt_s)); }

}  // namespace

TEST_CASE("A sensor that is silent too long, or not finite, takes its joint off") {
  Bench silent;
  silent.health.joints[0].silent_ticks = 5;
  CHECK(silent.check().mode == ActuationMode::effort);
  silent.health.joints[0].silent_ticks = 6;
  CHECK(silent.check().mode == ActuationMode::off);
  CHECK(silent.codes() == "sensor_silent");
  Bench broken;
  broken.health.joints[0].finite = false;
  CHECK(broken.check().mode == ActuationMode::off);
  CHECK(broken.codes() == "sensor_not_finite");
}

TEST_CASE("A joint that is sampled slower may be silent for its period") {
  Bench bench;
  bench.health.joints[0].period_ticks = 10;
  bench.health.joints[0].silent_ticks = 14;
  CHECK(bench.check().mode == ActuationMode::effort);
  bench.health.joints[0].silent_ticks = 15;
  CHECK(bench.check().mode == ActuationMode::off);
}

TEST_CASE("A reading that steps further than the joint can move is a jump, what it can move is none") {
  Bench bench;
  bench.check();
  bench.place(1 + 0.001 * 16 + 0.009);
  bench.check();
  CHECK(bench.codes().empty());
  bench.place(1.2);
  CHECK(bench.check().mode == ActuationMode::off);
  CHECK(bench.codes() == "sensor_jump");
  CHECK(bench.faults[0].value == doctest::Approx(0.175));
  CHECK(bench.faults[0].limit == doctest::Approx(0.026));
}

TEST_CASE("After missing readings a joint may be as far as it can have gone since") {
  Bench bench;
  bench.check();
  for (std::uint32_t i = 1; i <= 4; ++i) {
    bench.health.joints[0].silent_ticks = i;
    bench.check();
  }
  bench.health.joints[0].silent_ticks = 0;
  bench.place(1 + 0.005 * 16);
  bench.check();
  CHECK(bench.codes().empty());
}

TEST_CASE("A reading that stays the same while the motor moves is stuck, one at rest is not") {
  Bench bench;
  bench.knee_noise = false;
  bench.check_for(1);
  CHECK(bench.codes().empty());
  bench.sensors.joints[0].motor_position_rad += 0.06;
  bench.check();
  CHECK(bench.codes() == "sensor_stuck");
  CHECK(bench.status.level == SafetyLevel::off);
  Bench quick;
  quick.knee_noise = false;
  quick.check();
  quick.sensors.joints[0].motor_position_rad += 0.06;
  CHECK(quick.ticks_until(FaultCode::sensor_stuck) <= promised(FaultCode::sensor_stuck));
}

TEST_CASE("A reading that stays the same while more and more torque is asked is stuck") {
  Bench bench;
  bench.knee_noise = false;
  bench.check();
  bench.ask(14);  // from 5: 36 % of the limit
  const int ticks = bench.ticks_until(FaultCode::sensor_stuck);
  CHECK(ticks > 20);
  CHECK(ticks <= promised(FaultCode::sensor_stuck));
  Bench still;
  still.knee_noise = false;
  still.check_for(0.01);
  still.place(1.0001);  // from here on it stays, with 5 Nm
  still.ask(10);
  still.check_for(1);
  CHECK(still.codes().empty());
}

TEST_CASE("Behind a spring a joint that is pressed against something is not stuck, however hard its motor pulls") {
  SafetySettings springs = settings();
  for (JointLimits& limits : springs.joints) limits.spring_Nm_per_rad = 200;
  Bench bench(springs);
  bench.knee_noise = false;
  JointSample& knee = bench.sensors.joints[0];
  const double joint_rad = knee.position_rad;
  const auto pull = [&](double torque_Nm, double moved_rad) {
    bench.ask(torque_Nm);
    knee.motor_effort_Nm = torque_Nm;
    knee.motor_position_rad = joint_rad + moved_rad + torque_Nm / 200;  // by 0.08 rad as the torque grows
    bench.check();
  };
  for (int i = 0; i < 1000; ++i) pull(5 + 0.016 * i, 0);
  CHECK(bench.codes().empty());
  int ticks = 0;
  while (bench.codes().empty() && ticks < 1000) pull(5, 0.002 * ++ticks);  // the joint moves, its encoder does not
  CHECK(bench.codes() == "sensor_stuck");
  CHECK(ticks <= 60);  // 0.05 rad, and the mean's delay of 0.05 s at most
}

TEST_CASE("A rotor that swings on its spring, the joint pressed against its stop, is no stuck sensor") {
  SafetySettings springs = settings();
  for (JointLimits& limits : springs.joints) limits.spring_Nm_per_rad = 300;
  Bench bench(springs);
  bench.knee_noise = false;
  JointSample& knee = bench.sensors.joints[0];
  const double joint_rad = knee.position_rad;
  double deflection_rad = 0, rotor_rad_s = 0;
  for (int i = 0; i < 1000; ++i) {
    const double torque_Nm = i / 60 % 2 == 0 ? 20 : -20;  // 0.13 rad to and fro on the spring
    for (int part = 0; part < 10; ++part) {
      rotor_rad_s += 1e-4 * (torque_Nm - 300 * deflection_rad - 0.2 * rotor_rad_s) / 0.02;
      deflection_rad += 1e-4 * rotor_rad_s;
    }
    bench.ask(torque_Nm);
    knee.motor_effort_Nm = torque_Nm;
    knee.motor_position_rad = joint_rad + deflection_rad;
    bench.check();
  }
  CHECK(bench.codes().find("sensor_stuck") == std::string::npos);
}

TEST_CASE("A reading that follows its motor by a hair's breadth at a time is not stuck") {
  Bench bench;
  bench.knee_noise = false;
  for (int i = 0; i < 2000; ++i) {
    bench.place(1 + 1e-4 * (i / 10));
    bench.sensors.joints[0].motor_position_rad = 1 + 1e-5 * i;
    bench.ask(5 + 0.003 * i);
    bench.check();
  }
  CHECK(bench.codes().empty());
}

TEST_CASE("Without an IMU the robot holds until it is back") {
  for (const bool silent : {true, false}) {
    Bench bench;
    bench.check();
    if (silent) bench.health.imu.silent_ticks = 6;
    if (!silent) bench.health.imu.finite = false;
    bench.check();
    CHECK(bench.safety->robot_level() == SafetyLevel::hold);
    CHECK(bench.codes() == (silent ? "imu_silent" : "imu_not_finite"));
    bench.health.imu = {};
    bench.check_for(0.09);
    CHECK(bench.safety->robot_level() == SafetyLevel::hold);
    bench.check_for(0.03);
    CHECK(bench.safety->robot_level() == SafetyLevel::normal);
  }
  SafetySettings none = settings();
  none.sensors.imu = false;
  Bench bench(none);
  bench.health.imu.silent_ticks = 1000;
  bench.check_for(0.1);
  CHECK(bench.codes().empty());
}

TEST_CASE("An IMU whose noise ends is stuck, one that never had noise is not") {
  Bench bench;
  bench.check_for(0.2);
  bench.imu_noise = false;
  const int ticks = bench.ticks_until(FaultCode::imu_stuck);
  CHECK(ticks > 20);
  CHECK(ticks <= promised(FaultCode::imu_stuck));
  CHECK(bench.safety->robot_level() == SafetyLevel::hold);
  Bench ideal;
  ideal.imu_noise = false;
  ideal.check_for(1);
  CHECK(ideal.codes().empty());
}

TEST_CASE("An IMU that steps, or measures what it cannot, is reported") {
  for (const double rate_rad_s : {11.0, 50.0}) {
    Bench bench;
    bench.check();
    bench.imu_noise = false;
    bench.sensors.imu.angular_velocity_rad_s[0] = rate_rad_s;
    bench.check();
    CHECK(bench.codes() == "imu_jump");
    CHECK(bench.status.level == SafetyLevel::limited);
  }
  Bench bench;
  bench.sensors.imu.acceleration_m_s2[1] = -3000;
  bench.check();
  CHECK(bench.codes() == "imu_jump");
  CHECK(bench.faults[0].value == 3000);
}

TEST_CASE("A foot's failures limit the robot, and name the joint that carries it") {
  SafetySettings footed = settings();
  footed.foot_joints = {1};
  const auto failing = [&](FaultCode code, auto&& spoil) {
    Bench bench(footed);
    bench.check_for(0.2);
    bench.foot_noise = false;
    spoil(bench);
    const int ticks = bench.ticks_until(code);
    CAPTURE(name(code));
    CHECK(ticks > 0);
    CHECK(ticks <= promised(code));
    CHECK(bench.faults.back().joint == 1);
    CHECK(bench.safety->robot_level() == SafetyLevel::limited);
  };
  failing(FaultCode::foot_silent, [](Bench& b) { b.health.feet[0].silent_ticks = 6; });
  failing(FaultCode::foot_not_finite, [](Bench& b) { b.health.feet[0].finite = false; });
  failing(FaultCode::foot_jump, [](Bench& b) { b.sensors.feet[0].force_N[2] = 3e4; });
  failing(FaultCode::foot_jump, [](Bench& b) { b.sensors.feet[0].force_N[2] = -300; });
  failing(FaultCode::foot_stuck, [](Bench&) {});
}

TEST_CASE("A foot in the air, and a foot that the plant does not have, are no fault") {
  Bench air;
  air.check_for(0.2);
  air.foot_noise = false;
  air.sensors.feet[0].force_N = {};
  air.check_for(1);
  CHECK(air.codes() == "");
  Bench none;
  none.sensors.foot_count = 0;
  none.health.feet[0].silent_ticks = 1000;
  none.check_for(0.1);
  CHECK(none.codes() == "");
}

}  // namespace sensor_test

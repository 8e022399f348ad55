#include "kadans/safety/safety.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "kadans/testing/allocation_count.h"

using namespace kadans;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

RobotModel robot() {
  RobotModel model;
  model.links.resize(3);
  model.joints.resize(2);
  model.joints[0].name = "knee";
  model.joints[1].name = "toe";
  return model;
}

SafetySettings settings() {
  SafetySettings settings;
  settings.joints = {{.lower_rad = 0, .upper_rad = 2, .velocity_max_rad_s = 8, .effort_max_Nm = 25},
                     {.lower_rad = -0.4, .upper_rad = 0.4, .velocity_max_rad_s = 20, .effort_max_Nm = 0}};
  return settings;
}

struct Bench {
  std::unique_ptr<Safety> safety = std::make_unique<Safety>(settings(), robot());
  JointStates joints;
  SensorHealth health;
  ActuationFrame asked, written;
  SafetyStatus status;
  double heartbeat_age_s = 0;
  std::uint32_t missed_ticks = 0;
  std::uint64_t tick = 0;

  Bench() {
    joints.count = asked.joint_count = 2;
    joints.joints[0].position_rad = 1;
    asked.joints[0] = {.effort_Nm = 5, .mode = ActuationMode::effort};
  }
  const JointActuation& check() {
    written = asked;
    safety->check({tick++, 0.001, missed_ticks, heartbeat_age_s, joints, health}, written, status);
    return written.joints[0];
  }
  void check_for(double time_s) {
    for (int i = 0; i < std::lround(time_s / 0.001); ++i) check();
  }
  Fault fault() {
    Fault fault;
    (void)safety->log().try_pop(fault);
    return fault;
  }
};

bool damps(const JointActuation& actuation, double velocity_rad_s) {
  return actuation.mode == ActuationMode::effort && actuation.effort_Nm == doctest::Approx(-2.0 * velocity_rad_s);
}

}  // namespace

TEST_CASE("What is within the limits passes untouched") {
  Bench bench;
  CHECK(bench.check().effort_Nm == 5);
  CHECK(bench.status.level == SafetyLevel::normal);
  CHECK(bench.status.fault_count == 0);
}

TEST_CASE("Too much torque is limited and flagged once, and forgotten when it is over") {
  Bench bench;
  bench.asked.joints[0].effort_Nm = -40;
  CHECK(bench.check().effort_Nm == -25);
  CHECK(bench.status.level == SafetyLevel::limited);
  bench.check();
  CHECK(bench.status.fault_count == 1);
  CHECK(bench.fault().code == FaultCode::effort_limit);
  bench.asked.joints[0].effort_Nm = 5;
  CHECK(bench.check().effort_Nm == 5);
  CHECK(bench.status.level == SafetyLevel::normal);
}

TEST_CASE("An actuation that is not finite makes the joint damp until faults are cleared") {
  for (const double bad : {not_a_number, std::numeric_limits<double>::infinity()}) {
    Bench bench;
    bench.joints.joints[0].velocity_rad_s = 3;
    bench.asked.joints[0].effort_Nm = bad;
    CHECK(damps(bench.check(), 3));
    bench.asked.joints[0].effort_Nm = 5;
    CHECK(damps(bench.check(), 3));
    CHECK(bench.status.level == SafetyLevel::damp);
    CHECK(bench.status.first_fault.code == FaultCode::actuation_not_finite);
    bench.safety->clear();
    CHECK(bench.check().effort_Nm == 5);
    CHECK(bench.status.level == SafetyLevel::normal);
    CHECK(bench.status.fault_count == 0);
  }
}

TEST_CASE("A position beyond limit and margin, or NaN, makes the joint damp") {
  for (const double position_rad : {2.06, -0.06, not_a_number}) {
    Bench bench;
    bench.joints.joints[0].position_rad = position_rad;
    bench.joints.joints[0].velocity_rad_s = 1;
    CHECK(damps(bench.check(), 1));
    CHECK(bench.status.first_fault.code == FaultCode::position_limit);
    CHECK(bench.status.first_fault.joint == 0);
  }
  Bench bench;
  bench.joints.joints[0].position_rad = 2.04;
  CHECK(bench.check().effort_Nm == 5);
}

TEST_CASE("A velocity beyond limit and margin makes the joint damp, with no more than its torque") {
  Bench bench;
  bench.joints.joints[0].velocity_rad_s = 12.5;
  CHECK(bench.check().effort_Nm == doctest::Approx(-25));
  CHECK(bench.status.first_fault.code == FaultCode::velocity_limit);
  CHECK(bench.status.first_fault.limit == doctest::Approx(12));
}

TEST_CASE("A sensor that is silent too long, or not finite, takes its joint off") {
  Bench silent;
  silent.health.joints[0].silent_ticks = 5;
  CHECK(silent.check().mode == ActuationMode::effort);
  silent.health.joints[0].silent_ticks = 6;
  CHECK(silent.check().mode == ActuationMode::off);
  CHECK(silent.status.first_fault.code == FaultCode::sensor_silent);
  Bench broken;
  broken.health.joints[0].finite = false;
  CHECK(broken.check().mode == ActuationMode::off);
  CHECK(broken.status.first_fault.code == FaultCode::sensor_not_finite);
}

TEST_CASE("A joint that is sampled slower may be silent for its period") {
  Bench bench;
  bench.health.joints[0].period_ticks = 10;
  bench.health.joints[0].silent_ticks = 14;
  CHECK(bench.check().mode == ActuationMode::effort);
  bench.health.joints[0].silent_ticks = 15;
  CHECK(bench.check().mode == ActuationMode::off);
}

TEST_CASE("A lost heartbeat holds, then damps, then takes all torque; only holding is undone by its return") {
  Bench bench;
  bench.heartbeat_age_s = 0.2;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::hold);
  CHECK(bench.fault().code == FaultCode::heartbeat_lost);
  CHECK(bench.written.joints[0].effort_Nm == 5);  // the last set-points go on
  bench.heartbeat_age_s = 0;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::normal);
  bench.heartbeat_age_s = 0.2;
  bench.check_for(1.1);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.heartbeat_age_s = 0;
  bench.check_for(0.1);
  CHECK(bench.status.level == SafetyLevel::damp);
  bench.heartbeat_age_s = 0.2;
  bench.check_for(2.1);
  CHECK(bench.status.level == SafetyLevel::off);
  CHECK(bench.written.joints[0].mode == ActuationMode::off);
}

TEST_CASE("Overruns are counted; too many in a row degrade") {
  Bench bench;
  bench.missed_ticks = 1;
  for (int i = 0; i < 4; ++i) bench.check();
  bench.missed_ticks = 0;
  bench.check();
  CHECK(bench.status.level == SafetyLevel::normal);
  CHECK(bench.status.fault_count == 4);
  bench.missed_ticks = 2;
  for (int i = 0; i < 5; ++i) bench.check();
  CHECK(bench.status.level == SafetyLevel::damp);
}

TEST_CASE("A passive joint is never actuated") {
  Bench bench;
  bench.asked.joints[1] = {.effort_Nm = 3, .mode = ActuationMode::effort};
  bench.check();
  CHECK(bench.written.joints[1].mode == ActuationMode::off);
  CHECK(bench.written.joints[1].effort_Nm == 0);
}

TEST_CASE("The first fault is kept, later ones are counted") {
  Bench bench;
  bench.asked.joints[0].effort_Nm = 40;
  bench.check();
  bench.joints.joints[0].position_rad = 3;
  bench.check();
  CHECK(bench.status.first_fault.code == FaultCode::effort_limit);
  CHECK(bench.status.first_fault.tick == 0);
  CHECK(bench.status.fault_count >= 2);
}

TEST_CASE("Limits that make no sense are refused before the loop") {
  SafetySettings wrong = settings();
  wrong.joints[0].effort_max_Nm = not_a_number;
  CHECK_THROWS_AS(Safety(wrong, robot()), std::invalid_argument);
  wrong.joints.pop_back();
  CHECK_THROWS_AS(Safety(wrong, robot()), std::invalid_argument);
}

TEST_CASE("Checking allocates nothing") {
  Bench bench;
  bench.asked.joints[0].effort_Nm = not_a_number;
  const kadans::testing::AllocationCount heap;
  bench.check();
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}

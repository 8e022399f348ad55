// Two joints that two drives move together: limits of the drives, and what one joint's fault means for the other.
#include <doctest/doctest.h>

#include "bench.h"
#include "kadans/testing/allocation_count.h"

namespace coupling_test {

using namespace kadans;
using namespace kadans::safety_bench;

namespace {

// left = tilt + pan, right = tilt - pan: the left drive gives half of the sum of both torques.
SafetySettings neck_settings() {
  SafetySettings with = settings();
  for (JointLimits& joint : with.joints) {
    joint = {.lower_rad = -2, .upper_rad = 2, .velocity_max_rad_s = 8, .effort_max_Nm = 25};
    joint.drive_effort_max_Nm = 15;
    joint.drive_velocity_max_rad_s = 6;
  }
  with.sensors.stuck_ticks = 100000;  // the pan's reading has no noise
  return with;
}

Bench neck(const SafetySettings& with = neck_settings()) {
  RobotModel model = robot();
  model.transmissions.emplace_back(
      Transmission::Settings{.kind = Transmission::Kind::differential, .joints = {0, 1}, .drives = {"left", "right"}});
  Bench bench(with, model);
  bench.faults.reserve(8);
  bench.place(0);
  bench.sensors.joints[1].position_rad = 0;
  return bench;
}

void ask(Bench& bench, double tilt_Nm, double pan_Nm) {
  bench.asked.joints[0] = {.effort_Nm = tilt_Nm, .mode = ActuationMode::effort};
  bench.asked.joints[1] = {.effort_Nm = pan_Nm, .mode = ActuationMode::effort};
}

}  // namespace

TEST_CASE("Torques within the joints' limits that ask too much of one drive are scaled, and the drive is named") {
  Bench bench = neck();
  ask(bench, 14, 14);  // the left drive: 14 of 15 Nm
  bench.check_for(0.01);
  CHECK(bench.written.joints[1].effort_Nm == 14);
  CHECK(bench.codes().empty());
  ask(bench, 24, 12);  // 18 Nm
  const testing::AllocationCount heap;
  bench.check();
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(20));
  CHECK(bench.written.joints[1].effort_Nm == doctest::Approx(10));
  REQUIRE(bench.codes() == "effort_limit");
  CHECK(bench.faults[0].joint == 0);
  CHECK(std::string(bench.faults[0].words.data()) == "drive left: 18, limit 15");
  bench.check_for(0.1);
  CHECK(bench.codes() == "effort_limit");  // once, while it lasts
  CHECK(bench.status.level == SafetyLevel::limited);
  ask(bench, 12, 0);
  bench.check();
  ask(bench, 12, -24);  // now the right one
  bench.check_for(0.1);
  CHECK(bench.written.joints[1].effort_Nm == doctest::Approx(-20));
  REQUIRE(bench.codes() == "effort_limit effort_limit");
  CHECK(bench.faults[1].joint == 1);
}

TEST_CASE("Beyond a drive's speed its torque in that direction fades, although both joints are within theirs") {
  Bench bench = neck();
  ask(bench, 6, 6);
  bench.check();
  bench.joints.joints[0].velocity_rad_s = bench.joints.joints[1].velocity_rad_s = 3.75;  // 7.5 of 6..9 rad/s
  ask(bench, 10, 10);
  bench.check();
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(7.5));
  REQUIRE(bench.codes() == "soft_speed");
  CHECK(std::string(bench.faults[0].words.data()) == "drive left: 7.5, limit 6");
  ask(bench, -10, -10);
  bench.check();
  CHECK(bench.written.joints[0].effort_Nm == -10);  // it may brake
}

TEST_CASE("Speeds asked of coupled drives are kept within the drives' speed") {
  Bench bench = neck();
  for (std::size_t i = 0; i < 2; ++i) bench.asked.joints[i] = {.velocity_rad_s = 6, .mode = ActuationMode::velocity};
  bench.check();
  CHECK(bench.written.joints[0].velocity_rad_s == doctest::Approx(3));
  CHECK(bench.written.joints[1].velocity_rad_s == doctest::Approx(3));
  CHECK(bench.codes() == "soft_speed");
}

TEST_CASE("A fault of one coupled joint or its drive brings both down, and clearing brings both back") {
  Bench bench = neck();
  ask(bench, 5, 5);
  bench.check_for(0.01);
  bench.sensors.joints[1].drive = DriveState::fault;
  bench.joints.joints[0].velocity_rad_s = 1;
  bench.check_for(0.01);
  CHECK(bench.codes() == "drive_fault");
  CHECK(bench.faults[0].joint == 1);
  CHECK(bench.safety->joint_level(0) == bench.safety->joint_level(1));
  CHECK(bench.written.joints[0].effort_Nm != 5);
  bench.sensors.joints[1].drive = DriveState::enabled;
  bench.joints.joints[0].velocity_rad_s = 0;
  bench.safety->clear();
  bench.check_for(1);
  CHECK(bench.written.joints[0].effort_Nm == 5);
  CHECK(bench.written.joints[1].effort_Nm == 5);
}

TEST_CASE("An actuation of one coupled joint that is not finite lets the other give way, too") {
  Bench bench = neck();
  ask(bench, 5, not_a_number);
  bench.joints.joints[0].velocity_rad_s = 1;
  bench.check();
  CHECK(bench.written.joints[0].effort_Nm == doctest::Approx(-2.0));
}

TEST_CASE("Coupled joints that are asked for two modes damp in that tick, latched, and the fault says which modes") {
  Bench bench = neck();
  ask(bench, 5, 5);
  bench.check_for(0.01);
  bench.joints.joints[0].velocity_rad_s = bench.joints.joints[1].velocity_rad_s = 1;
  bench.asked.joints[1] = {.effort_Nm = 5, .position_rad = 0.5, .mode = ActuationMode::position};
  const testing::AllocationCount heap;
  bench.check();
  const long allocations = heap.count();
  CHECK(allocations == 0);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(bench.written.joints[i].mode == ActuationMode::effort);
    CHECK(bench.written.joints[i].effort_Nm == doctest::Approx(-2.0));
    CHECK(bench.safety->joint_level(i) == SafetyLevel::damp);
  }
  bench.check_for(0.1);
  REQUIRE(bench.codes() == "modes_differ");
  CHECK(fault_text(told(bench.faults[0], "tilt")) == "modes_differ of tilt: effort, the coupled joint position");
  ask(bench, 5, 5);
  bench.check_for(0.1);
  CHECK(bench.safety->joint_level(1) == SafetyLevel::damp);
  bench.joints.joints[0].velocity_rad_s = bench.joints.joints[1].velocity_rad_s = 0;
  bench.safety->clear();
  bench.check_for(1);
  CHECK(bench.written.joints[1].effort_Nm == 5);
}

TEST_CASE(
    "Two modes of coupled joints are not written whatever the configuration says, and off is effort without torque") {
  SafetySettings with = neck_settings();
  with.reactions[static_cast<std::size_t>(FaultCode::modes_differ)] = {};
  Bench bench = neck(with);
  bench.asked.joints[0] = {.effort_Nm = 5, .mode = ActuationMode::effort};
  bench.asked.joints[1] = {};
  bench.check_for(0.01);
  CHECK(bench.codes().empty());
  CHECK(bench.written.joints[0].effort_Nm == 5);
  bench.asked.joints[0] = {.velocity_rad_s = 1, .mode = ActuationMode::velocity};
  bench.check();
  CHECK(bench.codes() == "modes_differ");
  CHECK(bench.written.joints[0].mode == ActuationMode::effort);
}

TEST_CASE("Coupled joints that are pressed against something bend their drives' springs, and are not stuck for it") {
  SafetySettings springs = neck_settings();
  springs.sensors.stuck_ticks = settings().sensors.stuck_ticks;
  springs.joints[0].spring_Nm_per_rad = 200;  // left
  springs.joints[1].spring_Nm_per_rad = 50;
  Bench bench = neck(springs);
  bench.knee_noise = false;
  const auto pull = [&](double tilt_Nm, double pan_Nm, double moved_rad) {
    ask(bench, tilt_Nm, pan_Nm);
    const double left_rad = 0.5 * (tilt_Nm + pan_Nm) / 200, right_rad = 0.5 * (tilt_Nm - pan_Nm) / 50;
    bench.sensors.joints[0].motor_effort_Nm = tilt_Nm;
    bench.sensors.joints[1].motor_effort_Nm = pan_Nm;
    bench.sensors.joints[0].motor_position_rad = 0.5 * (left_rad + right_rad) + moved_rad;
    bench.sensors.joints[1].motor_position_rad = 0.5 * (left_rad - right_rad);
    bench.check();
  };
  for (int i = 0; i < 1000; ++i) pull(0.014 * i, -0.014 * i, 0);  // the right spring by 0.28 rad
  CHECK(bench.codes().empty());
  for (int i = 0; i < 1000 && bench.codes().empty(); ++i) pull(14, -14, 0.002 * i);
  CHECK(bench.codes() == "sensor_stuck");
}

}  // namespace coupling_test

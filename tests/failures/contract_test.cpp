// The failure contract, row by row: each test provokes what goes wrong (its description) and holds the runtime to its
// promise (its name). docs/failures.md is made from both and from how the tests end: see contract_table.cpp.
#include <limits>

#include <doctest/doctest.h>

#include "kadans/safety/detection.h"
#include "light_robot.h"

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

void spoil(LightRobot& robot, SensorFaultKind kind, SensorPlace place, double size = 0) {
  robot.plant.add({.kind = kind, .place = place, .index = 0, .from_ns = robot.time_ns + 1, .size = size});
}

// Ticks from `onset` until the fault was found; 0 when it was not.
std::int64_t found_after(const LightRobot& robot, FaultCode code, std::int64_t onset) {
  return robot.first(code) < 0 ? 0 : robot.first(code) - onset + 1;
}
bool in_time(const LightRobot& robot, FaultCode code, std::int64_t onset) {
  const std::int64_t ticks = found_after(robot, code, onset);
  return ticks > 0 && ticks <= detection_ticks(code, robot.limits(), 0.001);
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("after heartbeat_timeout_s the robot holds, after hold_s it damps, after damp_s it is off" *
          description("the behavior engine stalls")) {
  LightRobot robot(1);
  robot.run(200);
  robot.behaviors_alive = false;
  robot.run(150);
  CHECK(robot.first(FaultCode::heartbeat_lost) > 0);
  CHECK(robot.safety.robot_level() == SafetyLevel::hold);
  robot.run(1000);
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  robot.run(2000);
  CHECK(robot.safety.robot_level() == SafetyLevel::off);
  CHECK(robot.control.actuation().joints[0].mode != ActuationMode::position);
  CHECK(robot.broken_promise.empty());
}

TEST_CASE("while it is held set-points stay: commands are refused and counted, but for clearing faults" *
          description("the behavior engine stalls and somebody else commands")) {
  LightRobot robot(1);
  robot.run(200);
  robot.behaviors_alive = false;
  robot.run(150);
  const double before_rad = robot.plant.truth().position_rad[0];
  robot.move(0, 0.9, 0.1);
  robot.run(200);
  CHECK(robot.control.inbox().state().refused == 1);
  CHECK(std::abs(robot.plant.truth().position_rad[0] - before_rad) < 1e-3);
  robot.behaviors_alive = true;
  robot.send({.kind = CommandKind::clear_faults});
  robot.run(50);
  robot.move(0, 0.9, 0.2);
  robot.run(1000);
  CHECK(robot.plant.truth().position_rad[0] == doctest::Approx(0.9).epsilon(0.01));
}

TEST_CASE("the transaction is refused whole, counted and reported, nothing moves, nothing is clamped" *
          description("a command or set-point is not finite or out of range")) {
  for (const double wrong : {not_a_number, 1.51, -1e9}) {
    LightRobot robot(2);
    robot.run(100);
    robot.sender.begin(robot.time_ns);
    (void)robot.sender.add({.kind = CommandKind::set_point, .index = 0, .value = 0.5});
    (void)robot.sender.add({.kind = CommandKind::set_point, .index = 1, .value = wrong});
    (void)robot.sender.commit();
    const std::int64_t onset = robot.ticks();
    robot.run(300);
    CHECK(in_time(robot, FaultCode::command_refused, onset));
    CHECK(robot.control.inbox().state().refused == 2);
    CHECK(std::abs(robot.plant.truth().position_rad[0] - 0.1) < 1e-3);
  }
}

TEST_CASE("the transaction has expired: refused, counted, reported" * description("a command is too old")) {
  LightRobot robot(3);
  robot.run(200);
  robot.send({.kind = CommandKind::set_point, .index = 0, .value = 0.5}, 150'000'000);
  const std::int64_t onset = robot.ticks();
  robot.run(300);
  CHECK(in_time(robot, FaultCode::command_old, onset));
  CHECK(std::abs(robot.plant.truth().position_rad[0] - 0.1) < 1e-3);
}

TEST_CASE("the queue refuses what does not fit, visibly, what fitted is applied, none is lost" *
          description("the command queue is flooded")) {
  LightRobot robot(4);
  robot.run(100);
  for (int i = 0; i < 5000; ++i) robot.move(0, 0.3, 0.3);
  CHECK(robot.sender.refused() > 4000);
  robot.run(50);
  CHECK(robot.control.inbox().state().applied + robot.sender.refused() == 5000);
  CHECK(robot.faults.empty());
}

TEST_CASE("found within the ticks of safety/detection.h, the joint alone is off, latched" *
          description("a joint's sensor is silent, jumps or is not finite")) {
  struct Row {
    SensorFaultKind kind;
    FaultCode code;
  };
  for (const Row& row :
       {Row{SensorFaultKind::silent, FaultCode::sensor_silent}, Row{SensorFaultKind::jump, FaultCode::sensor_jump},
        Row{SensorFaultKind::not_finite, FaultCode::sensor_not_finite}}) {
    CAPTURE(name(row.code));
    LightRobot robot(5);
    robot.run(100);
    const std::int64_t onset = robot.ticks();
    spoil(robot, row.kind, SensorPlace::joint, 0.5);
    robot.run(300);
    CHECK(in_time(robot, row.code, onset));
    CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
    CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
    CHECK(robot.broken_promise.empty());
  }
}

TEST_CASE("found once the motor moves or pulls against the reading, the joint alone is off, latched" *
          description("a joint's sensor is stuck")) {
  LightRobot robot(5);
  robot.run(100);
  spoil(robot, SensorFaultKind::stuck, SensorPlace::joint);
  robot.move(0, -0.8, 0.3);
  robot.run(400);
  CHECK(robot.first(FaultCode::sensor_stuck) > 0);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
  CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
}

TEST_CASE("found in time, the robot holds until it is back (stuck: until cleared)" *
          description("the IMU is silent, stuck or not finite")) {
  struct Row {
    SensorFaultKind kind;
    FaultCode code;
    std::int64_t shows;  // ticks after the onset
  };
  for (const Row& row :
       {Row{SensorFaultKind::silent, FaultCode::imu_silent, 0}, Row{SensorFaultKind::stuck, FaultCode::imu_stuck, 1},
        Row{SensorFaultKind::not_finite, FaultCode::imu_not_finite, 0}}) {
    CAPTURE(name(row.code));
    LightRobot robot(6);
    robot.run(200);
    const std::int64_t onset = robot.ticks();
    spoil(robot, row.kind, SensorPlace::imu);
    robot.run(100);
    CHECK(in_time(robot, row.code, onset + row.shows));
    CHECK(robot.safety.robot_level() == SafetyLevel::hold);
  }
}

TEST_CASE("found in time, the robot goes on, limited and flagged" *
          description("a foot's sensor is silent, stuck, out of its range or not finite")) {
  for (const SensorFaultKind kind :
       {SensorFaultKind::silent, SensorFaultKind::stuck, SensorFaultKind::offset, SensorFaultKind::not_finite}) {
    LightRobot robot(7);
    robot.run(200);
    spoil(robot, kind, SensorPlace::foot, 1e5);
    robot.run(100);
    CHECK(robot.faults.size() == 1);
    CHECK(robot.safety.robot_level() == SafetyLevel::limited);
  }
}

TEST_CASE("never written, the joint damps, latched until cleared" * description("the actuation is not finite")) {
  for (const double wrong : {not_a_number, std::numeric_limits<double>::infinity()}) {
    LightRobot robot(8);
    robot.run(100);
    const std::int64_t onset = robot.ticks() + 1;
    robot.saboteur->arm(0, wrong);
    robot.run(300);
    CHECK(in_time(robot, FaultCode::actuation_not_finite, onset));
    CHECK(robot.safety.joint_level(0) == SafetyLevel::damp);
    CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
    CHECK(robot.broken_promise.empty());
  }
}

TEST_CASE("limited and flagged: torque within its limit, none into the soft stop or beyond the speed limit" *
          description("a joint passes its torque limit, a soft stop or its speed limit")) {
  LightRobot robot(9);
  robot.run(100);
  robot.saboteur->arm(0, 1000);
  robot.run(400);
  CHECK(robot.first(FaultCode::effort_limit) == 101);
  CHECK(robot.first(FaultCode::soft_stop) > 0);
  CHECK(robot.safety.joint_level(0) >= SafetyLevel::limited);
  CHECK(robot.control.state().joints.joints[0].velocity_rad_s <= 15);
  CHECK(robot.broken_promise.empty());
}

TEST_CASE("the joint damps, latched until cleared" * description("a joint passes a hard limit")) {
  LightRobot robot(10);
  robot.run(100);
  // A slow offset, below every jump, takes the reading beyond the limit and its margin.
  for (int i = 0; i < 300; ++i) {
    spoil(robot, SensorFaultKind::offset, SensorPlace::joint, 0.01);
    robot.saboteur->arm(0, 0);
    robot.tick();
  }
  CHECK(robot.first(FaultCode::position_limit) > 0);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::damp);
}

TEST_CASE("true dt is handed on, missed ticks are counted, N late ones in a row make the robot damp" *
          description("a tick overruns")) {
  LightRobot robot(11);
  robot.run(100);
  robot.tick(4 * period_ns, 3);
  robot.run(100);
  CHECK(robot.first(FaultCode::tick_overrun) == 100);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
  CHECK(robot.control.row()[robot.catalog.signals.find("safety.missed_ticks").value()] == 3);
  for (int i = 0; i < 5; ++i) robot.tick(2 * period_ns, 1);
  CHECK(robot.first(FaultCode::overruns) == 205);
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
}

TEST_SUITE_END();

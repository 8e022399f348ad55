// What the drives and their supply say of themselves: rows of the failure contract, as in contract_test.cpp.
#include <limits>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include "failures/light_robot.h"

namespace contract_drive_test {

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

constexpr double control_period_s = 1e-3;

void spoil(LightRobot& robot, ScenarioFault::Kind kind, double size = 0) {
  robot.faulty.add({.kind = kind, .from_ns = robot.time_ns + 1, .size = size});
}

void supply(LightRobot& robot, double supply_V) {
  robot.faulty.add({.kind = ScenarioFault::Kind::supply, .from_ns = robot.time_ns + 1, .size = supply_V});
}

int ticks(double time_s) { return static_cast<int>(time_s / control_period_s); }

const Fault& first_fault(const LightRobot& robot) {
  REQUIRE_FALSE(robot.faults.empty());
  return robot.faults.front();
}

// The first joint is as `level` says and stays so when the drive is well again, the others go on; clearing ends it.
void check_alone(LightRobot& robot, SafetyLevel level) {
  CHECK(robot.safety.joint_level(0) == level);
  CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
  robot.faulty.clear();
  robot.run(50);
  CHECK(robot.safety.joint_level(0) == level);
  robot.clear_faults();
  robot.run(ticks(robot.limits().recover_s) + 50);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::normal);
  CHECK(robot.broken_promise().empty());
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("in that tick the joint alone is off, latched, and the fault has the maker's code and words" *
          description("a drive says that something is wrong with it")) {
  for (const auto& [code, words] : {std::pair{18, "code 18: undervoltage"}, {19, "code 19"}}) {
    LightRobot robot(21);
    robot.run(100);
    const std::int64_t onset = robot.ticks();
    spoil(robot, ScenarioFault::Kind::drive_tripped, code);
    robot.run(3);
    CHECK(robot.in_time(FaultCode::drive_fault, onset));
    CHECK(fault_detail(told(first_fault(robot))) == words);
    CHECK(first_fault(robot).joint == 0);
    check_alone(robot, SafetyLevel::off);
  }
}

TEST_CASE("in that tick the joint alone is off, latched" *
          description("a drive that is asked for torque is not enabled any more")) {
  LightRobot robot(30);
  robot.run(100);
  const std::int64_t onset = robot.ticks();
  spoil(robot, ScenarioFault::Kind::drive_disabled);
  robot.run(3);
  CHECK(robot.in_time(FaultCode::drive_not_enabled, onset));
  CHECK(fault_detail(told(first_fault(robot))) == "ready");
  check_alone(robot, SafetyLevel::off);
}

TEST_CASE("after drives.enable_s the joint alone is off, latched" *
          description("a drive is asked for torque and was never enabled")) {
  LightRobot robot(22);
  constexpr std::int64_t asked =
      2;  // the first tick after one that wrote something: what was computed in tick 0 is written in 1
  robot.faulty.add({.kind = ScenarioFault::Kind::drive_disabled});
  robot.run(ticks(robot.limits().drives.enable_s) - 2);
  CHECK(robot.faults.empty());
  robot.run(5);
  CHECK(robot.in_time(FaultCode::drive_not_enabled, asked));
  CHECK(fault_detail(told(first_fault(robot))) == "ready");
  check_alone(robot, SafetyLevel::off);
}

TEST_CASE("it is reset, enabled, and follows again when the faults are cleared, without a jump" *
          description("a drive that has tripped is brought back by orders")) {
  LightRobot robot(29);
  const auto order = [&](DriveOrder what) {
    robot.send({.kind = CommandKind::order_drive, .index = 0, .count = static_cast<std::uint32_t>(what)});
    robot.run(12);
  };
  robot.run(100);
  order(DriveOrder::enable);  // which it is
  spoil(robot, ScenarioFault::Kind::drive_tripped, 18);
  robot.run(3);
  order(DriveOrder::enable);  // not before it is reset
  CHECK(robot.control.state().power.drives[0].state == DriveState::fault);
  order(DriveOrder::reset);
  CHECK(robot.control.state().power.drives[0].state == DriveState::ready);
  robot.clear_faults();
  robot.run(ticks(robot.limits().drives.enable_s) + 5);
  CHECK(robot.first(FaultCode::drive_not_enabled) > 0);
  order(DriveOrder::enable);
  CHECK(robot.control.state().power.drives[0].state == DriveState::enabled);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
  robot.clear_faults();
  robot.run(ticks(robot.limits().recover_s) + 50);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::normal);
  CHECK(robot.broken_promise().empty());
}

TEST_CASE("in that tick the joint alone damps, latched" * description("a drive says that it is too hot")) {
  LightRobot robot(23);
  robot.run(100);
  spoil(robot, ScenarioFault::Kind::drive_hot, robot.limits().drives.hot_C - 1);
  robot.run(50);
  CHECK(robot.faults.empty());
  robot.faulty.clear();
  const std::int64_t onset = robot.ticks();
  spoil(robot, ScenarioFault::Kind::drive_hot, robot.limits().drives.hot_C + 1);
  robot.run(3);
  CHECK(robot.in_time(FaultCode::drive_hot, onset));
  check_alone(robot, SafetyLevel::damp);
}

TEST_CASE("in that tick the joint alone is off, latched" *
          description("what a drive says was measured longer ago than drives.sample_age_max_s")) {
  LightRobot robot(24);
  robot.run(100);
  spoil(robot, ScenarioFault::Kind::drive_old, 0.9 * robot.limits().drives.sample_age_max_s);
  robot.run(50);
  CHECK(robot.faults.empty());
  robot.faulty.clear();
  const std::int64_t onset = robot.ticks();
  spoil(robot, ScenarioFault::Kind::drive_old, 1.1 * robot.limits().drives.sample_age_max_s);
  robot.run(3);
  CHECK(robot.in_time(FaultCode::sample_old, onset));
  check_alone(robot, SafetyLevel::off);
}

TEST_CASE("after supply.time_s the robot holds, after hold_s it damps, after damp_s it is off, and a dip is nothing" *
          description("the drives' supply is too low, or is not told any more")) {
  for (const double supply_V : {19.0, std::numeric_limits<double>::quiet_NaN()}) {
    LightRobot robot(25);
    robot.run(100);
    supply(robot, supply_V);
    robot.run(ticks(robot.limits().supply.time_s) - 1);
    robot.faulty.clear();
    robot.run(50);
    CHECK(robot.faults.empty());
    const std::int64_t onset = robot.ticks();
    supply(robot, supply_V);
    robot.run(ticks(robot.limits().supply.time_s) + 3);
    CHECK(robot.in_time(FaultCode::supply_low, onset));
    CHECK(robot.safety.robot_level() == SafetyLevel::hold);
    robot.run(ticks(robot.limits().hold_s));
    CHECK(robot.safety.robot_level() == SafetyLevel::damp);
    robot.run(ticks(robot.limits().damp_s));
    CHECK(robot.safety.robot_level() == SafetyLevel::off);
    CHECK(robot.broken_promise().empty());
  }
}

TEST_CASE("after supply.time_s the robot damps, latched" * description("the drives' supply is too high")) {
  LightRobot robot(26);
  robot.run(100);
  const std::int64_t onset = robot.ticks();
  supply(robot, 31);
  robot.run(ticks(robot.limits().supply.time_s) + 3);
  CHECK(robot.in_time(FaultCode::supply_high, onset));
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  robot.faulty.clear();
  robot.run(50);
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  robot.clear_faults();
  robot.run(50);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
}

TEST_CASE(
    "in that tick the robot damps, after damp_s it is off, until the button is let go and somebody outside lifts it" *
    description("somebody presses the emergency stop's button, an input of the plant")) {
  LightRobot robot(27);
  robot.run(100);
  robot.move(0, 0.9, 0.5);
  robot.run(50);
  const std::int64_t onset = robot.ticks();
  robot.faulty.add({.kind = ScenarioFault::Kind::emergency_button, .from_ns = robot.time_ns + 1});
  robot.run(2);
  CHECK(robot.in_time(FaultCode::emergency_input, onset));
  CHECK(fault_detail(told(first_fault(robot))) == "the button");
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  robot.run(ticks(robot.limits().damp_s) + 5);
  CHECK(robot.safety.robot_level() == SafetyLevel::off);
  robot.safety.emergency_stop().lift();
  robot.run(20);
  CHECK(robot.safety.robot_level() >= SafetyLevel::damp);
  robot.faulty.clear();
  robot.clear_faults();  // of a behavior
  robot.run(20);
  CHECK(robot.safety.robot_level() >= SafetyLevel::damp);
  robot.safety.emergency_stop().lift();
  robot.run(50);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
}

TEST_SUITE_END();

TEST_CASE("A drive that is asked for nothing need not be enabled") {
  LightRobot robot(28);
  robot.run(100);
  robot.safety.emergency_stop().ask("the test");
  robot.run(ticks(robot.limits().damp_s) + 10);
  REQUIRE(robot.safety.robot_level() == SafetyLevel::off);
  spoil(robot, ScenarioFault::Kind::drive_disabled);
  robot.run(2 * ticks(robot.limits().drives.enable_s));
  CHECK(robot.first(FaultCode::drive_not_enabled) < 0);
}

}  // namespace contract_drive_test

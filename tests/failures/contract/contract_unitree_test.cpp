// Rows of the failure contract for a robot on DDS: the driver, the messages and the emulated robot of the plug-in
// plugins/unitree, on virtual time.
#include "failures/bus_robot.h"
#include "unitree_world.h"

namespace contract_unitree_test {

using namespace kadans;
using namespace kadans::bus;
using doctest::description;

namespace {

unitree::Settings of_robot() {
  unitree::Settings is;
  is.kind = unitree::find_kind("g1");
  is.period_s = 0.001;
  is.motors = {{.drive = "hip", .number = 1}, {.drive = "knee", .number = 3}};
  return is;
}

struct Robot : BusRobot<unitree::UnitreeWorld> {
  explicit Robot(const std::vector<EmulatedFault>& faults = {})
      : BusRobot(unitree::drive_code_words, 0, of_robot(), site()) {
    world.plan_faults(faults);
  }
  // By the time of the run: the constructor lets 0.22 s pass.
  static EmulatedFault at(const char* kind, const char* of = "", double size = 0, double for_s = 1e9) {
    return {.kind = kind, .of = of, .from_s = 0.3, .until_s = 0.3 + for_s, .size = size};
  }
  void check_all_off(FaultCode code) const {
    for (const std::size_t joint : {0U, 1U}) {
      CHECK(safety.joint_level(joint) == SafetyLevel::off);
      CHECK(std::abs(world.truth().motor_torque_Nm[joint]) < 0.01);
    }
    CHECK(status().first_fault.code == code);
  }
  std::uint64_t count(std::string_view name) const {
    for (const PlantCount& one : world.link_counts()) {
      if (one.name == name) return one.value;
    }
    return ~std::uint64_t{0};
  }
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("this program stops writing, every joint is off, latched, and the fault says who is in the way" *
          description("somebody else writes commands to a robot on DDS: its own motion service, another program")) {
  Robot robot({Robot::at("second_writer", "", 0, 0.1)});
  robot.run(90);
  const std::uint64_t commands = robot.count("commands");
  CHECK(fault_detail(told(robot.status().first_fault)).find("others write rt/lowcmd") != std::string::npos);
  robot.run(400);
  robot.check_all_off(FaultCode::drive_fault);
  CHECK(robot.count("commands") == commands);
  CHECK(robot.world.electronics().any_watchdog_tripped());
}

TEST_CASE("the joints are off, latched, and the robot damps by itself within watchdog_s" *
          description("a robot on DDS is silent: its cable is out")) {
  Robot robot({Robot::at("cable_out")});
  robot.run(80 + 1 + 100);
  CHECK(robot.world.electronics().any_watchdog_tripped());
  for (const std::size_t joint : {0U, 1U}) CHECK(robot.safety.joint_level(joint) == SafetyLevel::off);
}

TEST_CASE("they are not used, each kind is counted, and within the bounds nothing else is noticed" *
          description("states of a robot on DDS are lost, corrupt or come again")) {
  Robot robot(
      {Robot::at("states_lost", "", 0.1), Robot::at("states_corrupt", "", 0.1), Robot::at("states_again", "", 0.1)});
  robot.run(2000);
  CHECK(robot.count("corrupt") > 50);
  CHECK(robot.count("stale") > 50);
  CHECK(robot.status().fault_count == 0);
  CHECK(std::abs(robot.hip_rad() - 0.5) < 0.05);
}

TEST_CASE("that joint alone is off, latched" * description("a robot on DDS tells a position that is no number")) {
  Robot robot({Robot::at("drive_not_finite", "hip")});
  robot.run(100);
  CHECK(robot.count("not_finite") > 0);
  robot.check_hip_alone(FaultCode::sensor_not_finite);
}

TEST_CASE("that joint alone is off, latched, the fault has the motor's code" *
          description("a motor of a robot on DDS says that something is wrong with it")) {
  Robot robot({Robot::at("drive_tripped", "hip", 8)});
  robot.run(100);
  CHECK(robot.status().first_fault.value == 8);
  robot.check_hip_alone(FaultCode::drive_fault);
}

TEST_CASE("the joints are off, latched, and nothing is written before a reset" *
          description("a robot on DDS restarts while it is driven")) {
  Robot robot({Robot::at("robot_restarts")});
  robot.run(90);
  const std::uint64_t commands = robot.count("commands");
  CHECK(robot.count("restarts") == 1);
  CHECK(fault_detail(told(robot.status().first_fault)).find("the robot restarted") != std::string::npos);
  robot.run(300);
  CHECK(robot.count("commands") == commands);
  robot.check_all_off(FaultCode::drive_fault);
}

TEST_CASE("within watchdog_s the emulated robot damps by itself" *
          description("the process that drives a robot on DDS hangs or dies")) {
  Robot robot;
  robot.world.silent = true;
  robot.run(102, false);
  CHECK(robot.world.electronics().any_watchdog_tripped());
  robot.world.silent = false;
  robot.run(3);
  CHECK_FALSE(robot.world.electronics().any_watchdog_tripped());
}

TEST_SUITE_END();

}  // namespace contract_unitree_test

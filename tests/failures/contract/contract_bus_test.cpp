// Rows of the failure contract for drives on a bus: servos on a serial line and HostMot2 boards on Ethernet, with the
// driver, the true bytes and the emulated drives, on virtual time.
#include <doctest/doctest.h>

#include "failures/bus_robot.h"
#include "kadans/signal/input_error.h"
#include "plant/dynamixel/emulator/servo_world.h"
#include "plant/hostmot2/emulator/board_world.h"
#include "plant/imu/emulator/imu_world.h"

namespace contract_bus_test {

using namespace kadans;
using namespace kadans::bus;
using doctest::description;

namespace {

dynamixel::DynamixelSettings servo_settings() {
  dynamixel::DynamixelSettings settings;
  settings.ports = {{.name = "bus", .device = "the bus", .baud = 3'000'000}};
  settings.servos = {
      {.drive = "hip", .port = "bus", .id = 1, .model = dynamixel::find_model("XM430-W210")},
      {.drive = "knee", .port = "bus", .id = 2, .model = dynamixel::find_model("XM430-W210"), .reversed = true}};
  return settings;
}

struct Servos : BusRobot<dynamixel::ServoWorld> {
  explicit Servos(double lowest_V = 0) : BusRobot(dynamixel::drive_code_words, lowest_V, servo_settings(), site()) {}
};

// A board for each joint.
hostmot2::HostMot2Settings board_settings() {
  hostmot2::HostMot2Settings settings;
  settings.boards = {{.name = "upper", .address = "192.168.1.121", .card = "7I96"},
                     {.name = "lower", .address = "192.168.1.122", .card = "7I96"}};
  hostmot2::DriveWiring hip{.drive = "hip", .board = "upper", .encoder = 0, .pwm = 0, .counts_per_rad = 10'000};
  hip.amplifier = {.full = 10, .current_max_A = 5, .Nm_per_A = 0.05, .gear = 10, .efficiency = 0.8};
  hip.enable = hostmot2::PinSettings{.number = 20};
  hip.fault = hostmot2::PinSettings{.number = 21, .low = true};
  hostmot2::DriveWiring knee = hip;
  knee.drive = "knee";
  knee.board = "lower";
  settings.drives = {hip, knee};
  settings.emergency_board = "upper";
  settings.emergency = hostmot2::PinSettings{.number = 30, .low = true};
  return settings;
}

struct Boards : BusRobot<hostmot2::BoardWorld> {
  Boards() : BusRobot(hostmot2::drive_code_words, 0, board_settings(), board_settings(), site()) {}
};

// The same boards with an IMU on a serial line beside them.
struct BoardsBesideImu : imu::ImuWorld {
  explicit BoardsBesideImu(std::unique_ptr<World> model)
      : BoardsBesideImu(new hostmot2::BoardWorld(std::move(model), board_settings(), board_settings(), site())) {}
  explicit BoardsBesideImu(hostmot2::BoardWorld* made)
      : ImuWorld(std::unique_ptr<World>(made), {.device = "the line"}, {1, 0, 0, 0}), boards(*made) {}
  hostmot2::BoardWorld& boards;
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE(
    "that joint alone is off, latched, the fault has the maker's words" *
    description("a drive on a bus says that something is wrong with it: a servo's overload, an amplifier's line")) {
  SUBCASE("servos") {
    Servos robot;
    robot.world.servos().servo(0).break_down(0x20);
    robot.run(10);
    CHECK(fault_detail(told(robot.status().first_fault)).find("overload") != std::string::npos);
    robot.check_hip_alone(FaultCode::drive_fault);
  }
  SUBCASE("boards") {
    Boards robot;
    robot.world.machine().fail_amplifier(0, true);
    robot.run(5);
    CHECK(fault_detail(told(robot.status().first_fault)).find("its amplifier reports a fault") != std::string::npos);
    robot.check_hip_alone(FaultCode::drive_fault);
  }
}

TEST_CASE("that board's joints alone are off, latched, the others are driven as before" *
          description("one of several boards on a network is silent")) {
  Boards robot;
  robot.world.machine().wire(0).pulled = true;
  robot.run(20);
  robot.check_hip_alone(FaultCode::drive_fault);
}

TEST_CASE("after silent_ticks_max readings the robot holds until it is back, and the drives go on" *
          description("an IMU on a serial line is silent: its cable is out")) {
  BusRobot<BoardsBesideImu> robot(hostmot2::drive_code_words, 0);
  robot.world.device().silent = true;
  robot.run(50);
  CHECK(robot.status().level == SafetyLevel::normal);
  robot.run(30);
  CHECK(robot.status().level == SafetyLevel::hold);
  CHECK(robot.status().first_fault.code == FaultCode::imu_silent);
  for (const std::size_t joint : {0U, 1U}) CHECK(robot.world.boards.machine().enabled(joint));
  robot.world.device().silent = false;
  robot.run(600);  // the fault must be over for a while
  CHECK(robot.status().level == SafetyLevel::normal);
}

TEST_CASE(
    "its joint is off, latched, and those whose readings grow older than sample_age_max_s while it is looked for" *
    description("a servo on a serial line is silent")) {
  Servos robot;
  robot.world.servos().servo(0).unplug(true);
  robot.run(150);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
  CHECK(robot.world.truth().motor_torque_Nm[0] == 0);
  CHECK(robot.effort_max_Nm < 4);
}

TEST_CASE("the joints are off, latched, and the drives have let go by themselves within watchdog_s" *
          description("all drives on a bus are silent: the cable is pulled")) {
  SUBCASE("servos") {
    Servos robot;
    for (const std::size_t joint : {0U, 1U}) robot.world.servos().servo(joint).unplug(true);
    robot.run(150);
    for (const std::size_t joint : {0U, 1U}) CHECK(robot.safety.joint_level(joint) == SafetyLevel::off);
    CHECK(robot.world.truth().motor_torque_Nm[0] == 0);
  }
  SUBCASE("boards") {
    Boards robot;
    for (const std::size_t board : {0U, 1U}) robot.world.machine().wire(board).pulled = true;
    robot.run(11);
    for (const std::size_t joint : {0U, 1U}) CHECK_FALSE(robot.world.machine().enabled(joint));
    robot.run(20);
    for (const std::size_t joint : {0U, 1U}) CHECK(robot.safety.joint_level(joint) == SafetyLevel::off);
    CHECK(robot.world.truth().motor_torque_Nm[0] == 0);
  }
}

TEST_CASE(
    "refused before anything moves: which drive, what it is, what was meant" *
    description("another device is on the bus: a servo of another model, another board, firmware without a module")) {
  const auto refused = [](OneRobotWorld& world, auto start) {
    try {
      start();
    } catch (const InputError& error) {
      CHECK(world.truth().motor_torque_Nm[0] == 0);
      return std::string(error.what());
    }
    return std::string();
  };
  const auto model = [] { return std::make_unique<IdealWorld>(bench::robot(), bench::plant_settings()); };
  SUBCASE("servos") {
    dynamixel::ServoWorld world(model(), servo_settings(), site());
    world.servos().servo(0) = dynamixel::EmulatedServo({.id = 1, .model = 1020, .baud_code = 5});
    CHECK(refused(world, [&] { world.start(); }).find("is XM430-W350, the configuration says XM430-W210") !=
          std::string::npos);
  }
  SUBCASE("boards") {
    hostmot2::HostMot2Settings there = board_settings();
    there.boards[1].card = "7I92";
    hostmot2::BoardWorld world(model(), board_settings(), there, site());
    CHECK(refused(world, [&] {
            world.start();
          }).find("board 'lower' at 192.168.1.122 is a 7I92, the configuration says 7I96") != std::string::npos);
  }
  SUBCASE("firmware") {
    hostmot2::HostMot2Settings wanted = board_settings();
    wanted.drives[1].encoder = 3;
    hostmot2::BoardWorld world(model(), wanted, board_settings(), site());
    CHECK(refused(world, [&] { world.start(); }).find("has no encoder 3: its firmware has") != std::string::npos);
  }
}

TEST_CASE("that joint alone is off, latched: it let go by itself" * description("a servo overheats")) {
  Servos robot;
  robot.world.servos().servo(0).heat_to(82);
  robot.run(10);
  CHECK(fault_detail(told(robot.status().first_fault)).find("overheating") != std::string::npos);
  robot.check_hip_alone(FaultCode::drive_fault);
}

TEST_CASE("after safety.supply.time_s it is the fault supply_low" *
          description("servos measure a supply below safety.supply")) {
  const SafetySettings watched = Servos::watched(nullptr, 13);
  dynamixel::ServoWorld world(std::make_unique<IdealWorld>(bench::robot(), bench::plant_settings()), servo_settings(),
                              site());
  const RobotModel model = bench::robot();
  EngineSettings settings;
  Catalog catalog;
  Estimator estimator(model, {}, 0.001);
  Safety safety(watched, model);
  ControlSets sets(catalog, bench::posture(catalog, model));
  const auto exchange = std::make_unique<EngineExchange>();
  ControlEngine control(settings, world, estimator, safety, sets, catalog, *exchange);
  std::int64_t time_ns = 0;
  for (; time_ns < 70 * tick_ns; time_ns += tick_ns) {
    control.tick(time_ns, 0.001, 0);
    world.step(tick_ns);
  }
  CHECK(control.state().status.safety.first_fault.code == FaultCode::supply_low);
}

TEST_CASE("in the tick that reads it the robot damps, whatever the configuration says" *
          description("somebody presses the emergency stop's button, which is wired to a board")) {
  Boards robot;
  robot.world.machine().press_emergency(true);
  robot.run(3);
  CHECK(robot.status().first_fault.code == FaultCode::emergency_input);
  CHECK(robot.status().level == SafetyLevel::damp);
}

TEST_CASE(
    "within watchdog_s every drive is in its safe state by itself: a servo without torque, a board's pins inputs" *
    description("the process that drives a bus is killed, or hangs")) {
  SUBCASE("servos") {
    Servos robot;
    robot.world.silent = true;
    robot.run(130, false);
    CHECK(robot.world.servos().any_watchdog_tripped());
    CHECK(robot.world.truth().motor_torque_Nm[0] == 0);
    CHECK(robot.world.truth().motor_torque_Nm[1] == 0);
  }
  SUBCASE("boards") {
    Boards robot;
    robot.run(8, false);
    CHECK(robot.world.machine().enabled(0));
    robot.run(2, false);
    for (const std::size_t joint : {0U, 1U}) {
      CHECK_FALSE(robot.world.machine().enabled(joint));
      CHECK(robot.world.truth().motor_torque_Nm[joint] == 0);
    }
    CHECK(robot.world.machine().any_watchdog_tripped());
  }
}

TEST_CASE("readings keep their own times and are counted as late, no torque is beyond its limit" *
          description("a bus takes longer than its period: a USB adapter keeps bytes back, a network is full")) {
  SUBCASE("servos") {
    Servos robot;
    robot.world.servos().bus(0).set_usb_latency(9 * tick_ns / 5);
    robot.run(2000);
    const std::vector<PlantCount> counts = robot.world.driver().link_counts();
    CHECK(std::string_view(counts[5].name) == "late");
    CHECK(counts[5].value > 100);
    CHECK(robot.effort_max_Nm < 20);
  }
  SUBCASE("boards") {
    Boards robot;
    for (const std::size_t board : {0U, 1U})
      robot.world.machine().wire(board).faults = {.late = 1, .late_ns = 3 * tick_ns};
    robot.run(2000);
    CHECK(robot.status().level == SafetyLevel::normal);
    CHECK(robot.hip_rad() == doctest::Approx(0.5).epsilon(0.05));
    for (const PlantCount& one : robot.world.driver().link_counts()) {
      if (std::string_view(one.name) == "late") CHECK(one.value > 3900);
      if (std::string_view(one.name) == "bites") CHECK(one.value == 0);
    }
  }
}

TEST_SUITE_END();

}  // namespace contract_bus_test

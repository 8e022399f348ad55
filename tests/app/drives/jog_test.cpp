// `kadans jog` and `kadans run --read-only`, on models, servos and boards.
#include "app/bench/jog.h"

#include <cmath>
#include <sstream>

#include <doctest/doctest.h>

#include "app/program.h"
#include "kadans/testing/allocation_count.h"
#include "plant/dynamixel/emulator/servo_world.h"
#include "plant/hostmot2/hostmot2_bench.h"

namespace jog_test {

using namespace kadans;
using namespace kadans::program;

namespace {

constexpr std::int64_t ms = 1'000'000;

// A person at a keyboard, and a robot in whatever way it is driven.
template <typename DrivenWorld>
struct Pusher {
  DrivenWorld& world;
  Jog jog{{.joint = 0, .torque_Nm = 0.5, .velocity_max_rad_s = 0.5, .lower_rad = -1, .upper_rad = 1}};
  SensorFrame sensors;
  ActuationFrame actuation;
  std::int64_t now_ns = 0;

  // A key that is held for so long repeats every 30 ms; 0: none is pressed.
  void hold(int direction, int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      world.read(sensors);
      if (direction != 0 && i % 30 == 0) jog.key(direction, now_ns);
      jog.step(sensors, now_ns, actuation);
      world.write(actuation);
      world.step(ms);
      now_ns += ms;
    }
  }
};

template <typename DrivenWorld>
void check_jog(DrivenWorld& world) {
  Pusher<DrivenWorld> by{world};
  by.hold(0, 100);
  const double at_rest = world.truth().position_rad[0];
  CHECK(std::abs(at_rest - 0.1) < 1e-3);
  by.hold(1, 1000);
  const double pushed = world.truth().position_rad[0];
  CHECK(pushed > at_rest + 0.05);
  CHECK(world.truth().velocity_rad_s[0] < 0.51);  // the torque ends at this speed
  CHECK(std::abs(world.truth().position_rad[1] + 0.2) < 1e-3);
  by.hold(0, 200);  // let go: within the time that a key counts, and what the drive takes
  CHECK(by.actuation.joints[0].mode == ActuationMode::off);
  CHECK(world.truth().motor_torque_Nm[0] == 0);
  by.hold(-1, 1500);
  CHECK(world.truth().velocity_rad_s[0] < 0);
  CHECK(by.jog.stopped() == Jog::Stop::none);
}

}  // namespace

TEST_CASE("A joint is pushed while a key is held and let go after, on boards, servos and a model") {
  SUBCASE("boards") {
    hostmot2::bench::Bench bench;
    check_jog(bench.world);
  }
  SUBCASE("a model") {
    IdealWorld world(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}});
    check_jog(world);
  }
  SUBCASE("servos") {
    dynamixel::DynamixelSettings settings;
    settings.ports = {{.name = "bus", .device = "the bus", .baud = 3'000'000}};
    settings.servos = {
        {.drive = "hip", .port = "bus", .id = 1, .model = dynamixel::find_model("XM430-W210")},
        {.drive = "knee", .port = "bus", .id = 2, .model = dynamixel::find_model("XM430-W210"), .reversed = true}};
    dynamixel::ServoWorld world(
        std::make_unique<IdealWorld>(test::two_joints(), PlantSettings{.position_rad = {0.1, -0.2}}), settings,
        PlantSite{.file = "robot.json", .layout = {.robot = "walker", .joints = {"hip", "knee"}}});
    check_jog(world);
  }
}

TEST_CASE("A jog gives no torque beyond an end, with a fault, in silence, or with the emergency stop pressed") {
  Jog jog({.joint = 0, .torque_Nm = 1, .velocity_max_rad_s = 0.5, .lower_rad = -1, .upper_rad = 1});
  SensorFrame sensors;
  sensors.joint_count = 1;
  ActuationFrame actuation;
  std::int64_t now_ns = 0;
  const auto effort_at = [&](double position_rad, int direction) {
    now_ns += ms;
    sensors.time_ns = now_ns;
    sensors.joints[0].position_rad = position_rad;
    ++sensors.joints[0].sequence;
    jog.key(direction, now_ns);
    const testing::AllocationCount heap;
    jog.step(sensors, now_ns, actuation);
    const long allocations = heap.count();
    CHECK(allocations == 0);
    return actuation.joints[0].effort_Nm;
  };
  CHECK(effort_at(0.999, 1) == 1);
  CHECK(effort_at(1.0, 1) == 0);
  CHECK(effort_at(1.0, -1) < 0);
  CHECK(effort_at(1.0, 0) == 0);
  sensors.emergency = true;
  CHECK(effort_at(1.0, -1) == 0);
  sensors.emergency = false;
  for (int i = 0; i < 101; ++i) {
    jog.key(-1, now_ns);
    jog.step(sensors, now_ns, actuation);
  }
  CHECK(jog.stopped() == Jog::Stop::drive);
  CHECK(jog.drive_stopped() == PushedJoint::Stop::silent);
  CHECK(actuation.joints[0].mode == ActuationMode::off);
  Jog other({.joint = 0, .torque_Nm = 1, .lower_rad = -1, .upper_rad = 1});
  sensors.joints[0].drive = DriveState::fault;
  other.key(1, now_ns);
  other.step(sensors, now_ns, actuation);
  CHECK(other.stopped() == Jog::Stop::drive);
  CHECK(other.drive_stopped() == PushedJoint::Stop::fault);
  CHECK(actuation.joints[0].mode == ActuationMode::off);
  CHECK(effort_at(std::nan(""), -1) == 0);
}

TEST_CASE("kadans jog ends when its keys are gone, and says what it moved") {
  const auto folder = project_copy("jog");
  Outcome outcome = run("jog config/jiwiy/robot.json pan --plant ideal", folder);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, " rad; the keys are gone"));
  outcome = run("jog config/jiwiy/robot.json pam", folder);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "the robot has no joint 'pam', did you mean 'pan'?"));
  outcome = run("jog config/tulip/robot.json l_ankle_roll", folder);
  CHECK(has(outcome.err, "joint 'l_ankle_roll' is passive: nothing moves it"));
}

TEST_CASE("A run that only reads moves nothing, and its drives are no fault") {
  const auto folder = project_copy("read_only");
  const Outcome outcome =
      run("run config/jiwiy/robot.json --read-only --play sine --threads-on-virtual-time --duration 3 --no-ctl "
          "--record read.mcap",
          folder);
  CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
  const Outcome csv = run("log csv read.mcap joint.pan.position_rad --every 0.1", folder);
  std::istringstream lines(csv.out);
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t comma = line.find(',');
    if (comma == std::string::npos || line.find_first_of("0123456789") != 0) continue;
    ++rows;
    CHECK(std::abs(std::stod(line.substr(comma + 1))) < 0.01);
  }
  CHECK(rows > 20);
  CHECK_FALSE(has(outcome.err + outcome.out, "not enabled"));
  CHECK_FALSE(has(outcome.err + outcome.out, "drive_not_enabled"));
}

}  // namespace jog_test

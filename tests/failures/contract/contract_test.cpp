// The failure contract, row by row: each test provokes what goes wrong (its description) and holds the runtime to its
// promise (its name). docs/failures.md is made from both: see contract_table.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "failures/light_robot.h"

namespace contract_test {

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

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
  CHECK(robot.broken_promise().empty());
}

TEST_CASE(
    "in that tick the robot damps, after damp_s it is off, as one fault that says who, until somebody outside lifts "
    "it" *
    description("somebody asks for the emergency stop")) {
  LightRobot robot(1);
  robot.run(200);
  robot.move(0, 0.9, 0.5);
  robot.run(100);
  robot.safety.emergency_stop().ask("uid 1000 (operate)");
  robot.run(1);
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  CHECK(robot.control.actuation().joints[0].mode != ActuationMode::position);
  robot.move(0, 0.2, 0.1);
  robot.run(static_cast<int>(1e3 * robot.safety.settings().damp_s) + 10);
  CHECK(robot.safety.robot_level() == SafetyLevel::off);
  CHECK(robot.control.inbox().state().refused == 1);
  CHECK(robot.first(FaultCode::emergency_stop) > 0);
  robot.send({.kind = CommandKind::clear_faults});  // of a behavior
  robot.run(50);
  CHECK(robot.control.inbox().state().refused == 2);
  CHECK(robot.safety.robot_level() == SafetyLevel::off);
  robot.safety.emergency_stop().lift();
  robot.run(50);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
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

TEST_CASE(
    "what is asked of it stays: its set-points, its object's parameters and another set are refused, the other "
    "joints go on" *
    description("one joint is held alone")) {
  Reactions gentle = default_reactions();
  gentle[static_cast<std::size_t>(FaultCode::sensor_not_finite)] = {.joint = SafetyLevel::hold, .latch = true};
  LightRobot robot(1, gentle);
  robot.run(100);
  robot.move(0, 0.5, 0.3);
  robot.run(50);
  robot.spoil(ScenarioFault::Kind::sensor_not_finite, SensorKind::joint);
  robot.run(2);
  robot.heal();
  robot.run(900);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::hold);
  CHECK(robot.position_rad(0) == doctest::Approx(0.5).epsilon(0.01));  // the motion under way was completed
  robot.move(0, 0.9, 0.1);
  robot.send({.kind = CommandKind::set_parameter, .index = 0, .value = 50});
  robot.send({.kind = CommandKind::switch_set, .index = 0});
  robot.move(1, 0.4, 0.3);
  robot.run(1000);
  CHECK(robot.control.inbox().state().refused == 3);
  CHECK(robot.position_rad(0) == doctest::Approx(0.5).epsilon(0.01));
  CHECK(robot.position_rad(1) == doctest::Approx(0.4).epsilon(0.01));
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
}

TEST_CASE("the others take set-points as before, when it is cleared it starts from where it is, without a step" *
          description("one joint damps or is off and is cleared")) {
  LightRobot robot(2);
  robot.run(100);
  robot.saboteur->arm(0, not_a_number);
  robot.run(50);
  robot.move("there", 0.3);
  robot.run(1000);
  CHECK(robot.control.inbox().state().refused == 0);
  CHECK(robot.position_rad(1) == doctest::Approx(0.3).epsilon(0.01));
  const double before_rad = robot.position_rad(0);
  CHECK(std::abs(before_rad - 0.1) < 0.01);  // it did not follow
  robot.saboteur->disarm();
  robot.clear_faults();
  double last_Nm = 0, step_Nm = 0;
  for (int i = 0; i < 1000; ++i) {
    robot.tick();
    const double effort_Nm = robot.plant.written().joints[0].effort_Nm;
    step_Nm = std::max(step_Nm, std::abs(effort_Nm - last_Nm));
    last_Nm = effort_Nm;
  }
  CHECK(robot.safety.joint_level(0) == SafetyLevel::normal);
  CHECK(std::abs(robot.position_rad(0) - before_rad) < 0.01);
  CHECK(step_Nm < 0.02 * 20);
  CHECK(robot.position_rad(1) == doctest::Approx(0.3).epsilon(0.01));
  CHECK(robot.broken_promise() == "");
}

TEST_CASE("set-points behind it count from where the joints are" *
          description("faults are cleared and set-points given in one transaction")) {
  LightRobot robot(3);
  robot.run(100);
  robot.saboteur->arm(0, not_a_number);
  robot.run(50);
  robot.saboteur->disarm();
  robot.sender.begin(robot.time_ns);
  (void)robot.sender.add({.kind = CommandKind::clear_faults});
  (void)robot.sender.add(robot.to(0, 0.4, 0.5));
  (void)robot.sender.commit();
  robot.run(1200);
  CHECK(robot.position_rad(0) == doctest::Approx(0.4).epsilon(0.01));
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
    CHECK(robot.in_time(FaultCode::command_refused, onset));
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
  CHECK(robot.in_time(FaultCode::command_old, onset));
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
    ScenarioFault::Kind kind;
    FaultCode code;
  };
  for (const Row& row : {Row{ScenarioFault::Kind::sensor_silent, FaultCode::sensor_silent},
                         Row{ScenarioFault::Kind::sensor_jump, FaultCode::sensor_jump},
                         Row{ScenarioFault::Kind::sensor_not_finite, FaultCode::sensor_not_finite}}) {
    CAPTURE(name(row.code));
    LightRobot robot(5);
    robot.run(100);
    const std::int64_t onset = robot.ticks();
    robot.spoil(row.kind, SensorKind::joint, 0, 0.5);
    robot.run(300);
    CHECK(robot.in_time(row.code, onset));
    CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
    CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
    CHECK(robot.broken_promise().empty());
  }
}

TEST_CASE("found once the motor moves or pulls against the reading, the joint alone is off, latched" *
          description("a joint's sensor is stuck")) {
  LightRobot robot(5);
  robot.run(100);
  robot.spoil(ScenarioFault::Kind::sensor_stuck, SensorKind::joint);
  robot.move(0, -0.8, 0.3);
  robot.run(400);
  CHECK(robot.first(FaultCode::sensor_stuck) > 0);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::off);
  CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
}

TEST_CASE("found in time, the robot holds until it is back (stuck: until cleared)" *
          description("the IMU is silent, stuck or not finite")) {
  struct Row {
    ScenarioFault::Kind kind;
    FaultCode code;
    std::int64_t shows;  // ticks after the onset
  };
  for (const Row& row : {Row{ScenarioFault::Kind::sensor_silent, FaultCode::imu_silent, 0},
                         Row{ScenarioFault::Kind::sensor_stuck, FaultCode::imu_stuck, 1},
                         Row{ScenarioFault::Kind::sensor_not_finite, FaultCode::imu_not_finite, 0}}) {
    CAPTURE(name(row.code));
    LightRobot robot(6);
    robot.run(200);
    const std::int64_t onset = robot.ticks();
    robot.spoil(row.kind, SensorKind::imu);
    robot.run(100);
    CHECK(robot.in_time(row.code, onset + row.shows));
    CHECK(robot.safety.robot_level() == SafetyLevel::hold);
  }
}

TEST_CASE("found in time, the robot goes on, limited and flagged" *
          description("a foot's sensor is silent, stuck, out of its range or not finite")) {
  for (const ScenarioFault::Kind kind : {ScenarioFault::Kind::sensor_silent, ScenarioFault::Kind::sensor_stuck,
                                         ScenarioFault::Kind::sensor_offset, ScenarioFault::Kind::sensor_not_finite}) {
    LightRobot robot(7);
    robot.run(200);
    robot.spoil(kind, SensorKind::foot, 0, 1e5);
    robot.run(100);
    CHECK(robot.faults.size() == 1);
    CHECK(robot.safety.robot_level() == SafetyLevel::limited);
  }
}

TEST_CASE("found in time, the robot goes on, limited and flagged, and the fault names the sensor" *
          description("a sensor that the configuration names is silent, out of its range or not finite")) {
  struct Row {
    ScenarioFault::Kind kind;
    FaultCode code;
    int period_ticks;  // until a reading shows it
  };
  for (const auto& [kind, code, period_ticks] :
       {Row{ScenarioFault::Kind::sensor_silent, FaultCode::channel_silent, 20},
        {ScenarioFault::Kind::sensor_offset, FaultCode::channel_range, 20},
        {ScenarioFault::Kind::sensor_not_finite, FaultCode::channel_not_finite, 20}}) {
    LightRobot robot(7);
    robot.run(210);
    CHECK(robot.faults.empty());
    CHECK(robot.control.state().status.channels[0] == 1.5);
    const std::int64_t onset = robot.ticks();
    robot.spoil(kind, SensorKind::channel, 0, 10);
    robot.run(100);
    CHECK(robot.first(code) >= onset);
    CHECK(robot.first(code) < onset + period_ticks + static_cast<std::int64_t>(robot.limits().silent_ticks_max) + 1);
    CHECK(robot.faults.size() == 1);
    CHECK(fault_detail(told(robot.faults.front())) == "front");
    CHECK(robot.safety.robot_level() == SafetyLevel::limited);
    CHECK(std::isfinite(robot.control.state().status.channels[0]));
  }
}

TEST_CASE("never written, the joint damps, latched until cleared" * description("the actuation is not finite")) {
  for (const double wrong : {not_a_number, std::numeric_limits<double>::infinity()}) {
    LightRobot robot(8);
    robot.run(100);
    const std::int64_t onset = robot.ticks() + 1;
    robot.saboteur->arm(0, wrong);
    robot.run(300);
    CHECK(robot.in_time(FaultCode::actuation_not_finite, onset));
    CHECK(robot.safety.joint_level(0) == SafetyLevel::damp);
    CHECK(robot.safety.joint_level(1) == SafetyLevel::normal);
    CHECK(robot.broken_promise().empty());
  }
}

TEST_CASE("in that tick both damp, latched until cleared, and the fault says which modes, the other joints go on" *
          description("two coupled joints are asked for different modes")) {
  const Transmission ankle({.kind = Transmission::Kind::four_bar_linkage, .joints = {0, 1}, .drives = {"a", "b"}});
  LightRobot robot(41, default_reactions(), {ankle});
  robot.run(100);
  const std::int64_t onset = robot.ticks() + 1;
  robot.saboteur->arm(1, {.position_rad = 0.1, .mode = ActuationMode::position});
  robot.run(300);
  REQUIRE(robot.in_time(FaultCode::modes_differ, onset));
  CHECK(fault_detail(told(robot.faults.front())) == "effort, the coupled joint position");
  CHECK(robot.plant.written().joints[1].mode == ActuationMode::effort);
  robot.saboteur->disarm();
  robot.run(50);
  for (const std::size_t joint : {0U, 1U}) CHECK(robot.safety.joint_level(joint) == SafetyLevel::damp);
  CHECK(robot.safety.joint_level(2) == SafetyLevel::normal);
  robot.clear_faults();
  robot.run(2000);
  CHECK(robot.safety.joint_level(0) == SafetyLevel::normal);
  CHECK(robot.codes() == "modes_differ");
  CHECK(robot.broken_promise().empty());
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
  CHECK(robot.broken_promise().empty());
}

TEST_CASE("the joint damps, latched until cleared" * description("a joint passes a hard limit")) {
  LightRobot robot(10);
  robot.run(100);
  // A slow offset, below every jump, takes the reading beyond the limit and its margin.
  for (int i = 0; i < 300; ++i) {
    robot.spoil(ScenarioFault::Kind::sensor_offset, SensorKind::joint, 0, 0.01);
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

}  // namespace contract_test

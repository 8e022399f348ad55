// Rows of the failure contract on TULip itself, in Bullet: what a failure does to a robot that stands, squats or falls.
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "failures/tulip_robot.h"

namespace contract_tulip_test {

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

constexpr double standing_m = 0.85;

// Of all joints: the largest torque that the drives gave meanwhile, as a share of the limit.
double run(TulipRobot& robot, int ticks) {
  double share = 0;
  for (int i = 0; i < ticks; ++i) {
    robot.tick();
    share = std::max(share, robot.torque_share());
  }
  return share;
}

// Stands, and is on its way to the squat.
void squat(TulipRobot& robot) {
  robot.run(300);
  robot.move("squat", 0.8);
  robot.run(400);
  REQUIRE(robot.codes() == "");
}

// Of all joints but one.
SafetyLevel worst_of_others(const TulipRobot& robot, std::size_t but) {
  SafetyLevel worst = SafetyLevel::normal;
  for (std::size_t i = 0; i < robot.model.joints.size(); ++i) {
    if (i != but) worst = std::max(worst, robot.safety.joint_level(i));
  }
  return worst;
}

void push_over(TulipRobot& robot) {
  for (int i = 0; i < 120; ++i) {
    robot.plant.push(0, {250, 0, 0}, {0, 0, 0.2});
    robot.tick();
  }
}

// The first tick since which the body has been beyond the limits of a fall, told by the truth.
bool beyond(const TulipRobot& robot) {
  const BaseStatus& base = robot.control.state().status.base;
  const FallSettings& fall = robot.limits().fall;
  return std::abs(base.pitch_rad) > fall.pitch_max_rad || std::abs(base.roll_rad) > fall.roll_max_rad;
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("found in time, the knee alone is off, latched, every torque stays within its limit while TULip sinks" *
          description("a knee's sensor is silent, jumps, is stuck or not finite while TULip squats")) {
  struct Row {
    ScenarioFault::Kind kind;
    FaultCode code;
    std::int64_t shows;  // ticks after the onset
  };
  for (const Row& row : {Row{ScenarioFault::Kind::sensor_silent, FaultCode::sensor_silent, 0},
                         Row{ScenarioFault::Kind::sensor_jump, FaultCode::sensor_jump, 0},
                         Row{ScenarioFault::Kind::sensor_stuck, FaultCode::sensor_stuck, 260},
                         Row{ScenarioFault::Kind::sensor_not_finite, FaultCode::sensor_not_finite, 0}}) {
    CAPTURE(name(row.code));
    TulipRobot robot(1);
    const std::size_t knee = robot.joint("l_knee");
    squat(robot);
    const std::int64_t onset = robot.ticks();
    robot.spoil(row.kind, SensorKind::joint, knee, 0.5);
    const double share = run(robot, 1500);
    CHECK(robot.faults.at(0).joint == knee);
    CHECK(robot.faults[0].tick == static_cast<std::uint64_t>(robot.first(row.code)));
    CHECK(robot.first(row.code) >= onset);
    if (row.shows == 0) CHECK(robot.in_time(row.code, onset));
    if (row.shows > 0) CHECK(robot.first(row.code) < onset + row.shows);
    CHECK(robot.safety.joint_level(knee) == SafetyLevel::off);
    CHECK(worst_of_others(robot, knee) < SafetyLevel::damp);
    CHECK(share <= 1.0);
    CHECK(robot.broken_promise() == "");
  }
}

TEST_CASE("the robot holds and stands, then damps and sinks, then is off, no torque passes its limit" *
          description("the behavior engine stalls while TULip squats")) {
  TulipRobot robot(2);
  squat(robot);
  robot.behaviors_alive = false;
  double share = run(robot, 1000);
  CHECK(robot.safety.robot_level() == SafetyLevel::hold);
  CHECK(robot.height_m() > standing_m - 0.11);  // the squat was completed, and it stands
  CHECK(robot.control.state().status.base.tilt_rad < 0.1);
  share = std::max(share, run(robot, 1000));
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  CHECK(robot.height_m() < standing_m - 0.15);
  share = std::max(share, run(robot, 1500));
  CHECK(robot.safety.robot_level() == SafetyLevel::off);
  CHECK(share <= 1.0);
  CHECK(robot.broken_promise() == "");
}

TEST_CASE("never written, the knee damps alone, latched, and comes back from where it is when it is cleared" *
          description("the actuation of TULip's knee is not finite")) {
  for (const double wrong : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TulipRobot robot(3);
    const std::size_t knee = robot.joint("r_knee");
    squat(robot);
    robot.saboteur->arm(knee, wrong);
    const std::int64_t onset = robot.ticks();
    double share = run(robot, 3000);  // by then it lies where dry friction let it sink to
    CHECK(robot.in_time(FaultCode::actuation_not_finite, onset + 1));
    CHECK(robot.safety.joint_level(knee) == SafetyLevel::damp);
    CHECK(worst_of_others(robot, knee) < SafetyLevel::damp);
    robot.saboteur->disarm();
    robot.clear_faults();
    const double before_rad = robot.position_rad(knee);
    share = std::max(share, run(robot, 1000));
    CHECK(robot.safety.joint_level(knee) <= SafetyLevel::limited);
    CHECK(std::abs(robot.position_rad(knee) - before_rad) < 0.1);
    CHECK(share <= 1.0);
    CHECK(robot.broken_promise() == "");
  }
}

TEST_CASE("refused, counted and reported, TULip stands as it stood" * description("a command to TULip is too old")) {
  TulipRobot robot(4);
  robot.run(500);
  const double before_m = robot.height_m();
  robot.send(robot.to(robot.joint("l_knee"), 2.0, 0.1), 200'000'000);
  const std::int64_t onset = robot.ticks();
  robot.run(500);
  CHECK(robot.in_time(FaultCode::command_old, onset));
  CHECK(robot.control.inbox().state().refused == 1);
  CHECK(std::abs(robot.height_m() - before_m) < 0.002);
  CHECK(robot.safety.robot_level() == SafetyLevel::normal);
}

TEST_CASE(
    "found in time, joints are soft on the way down, no torque passes its limit through the impact, torque is "
    "back when it lies" *
    description("TULip is pushed over")) {
  TulipRobot robot(5);
  robot.run(300);
  push_over(robot);
  std::int64_t shows = -1;
  double share = 0, soft_share = 0;
  for (int i = 0; i < 4000; ++i) {
    share = std::max(share, run(robot, 1));
    if (shows < 0 && beyond(robot)) shows = robot.ticks() - 1;
    if (robot.safety.fall_phase() != FallWatch::Phase::falling) continue;
    for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
      const double effort_Nm = std::abs(robot.plant.written().joints[j].effort_Nm);
      if (robot.limits().joints[j].effort_max_Nm <= 0 || robot.ticks() < robot.first(FaultCode::fall) + 5) continue;
      // A joint that was thrown about faster than it may turn damps with all it has.
      if (robot.safety.joint_level(j) >= SafetyLevel::damp) continue;
      soft_share = std::max(soft_share, effort_Nm / robot.limits().joints[j].effort_max_Nm);
    }
  }
  REQUIRE(shows > 0);
  CHECK(robot.in_time(FaultCode::fall, shows));
  CHECK(robot.signal("safety.impact_m_s2") > 20);
  CHECK(robot.safety.fall_phase() == FallWatch::Phase::fallen);
  CHECK(robot.height_m() < 0.4);
  CHECK(soft_share <= 0.25 * 2);
  CHECK(share <= 1.0);
  CHECK(robot.broken_promise() == "");
  CHECK(robot.control.state().status.safety.fault_count > 0);  // kept until cleared
}

TEST_CASE("the robot damps, latched, and after clearing it stays as it lies" *
          description("TULip falls, and its configuration wants it to damp until cleared")) {
  Reactions limp = default_reactions();
  limp[static_cast<std::size_t>(FaultCode::fall)] = {.robot = SafetyLevel::damp, .latch = true};
  TulipRobot robot(6, limp);
  robot.run(300);
  push_over(robot);
  double share = run(robot, 4000);
  CHECK(robot.safety.robot_level() == SafetyLevel::damp);
  CHECK(robot.height_m() < 0.4);
  std::vector<double> before_rad;
  for (std::size_t j = 0; j < robot.model.joints.size(); ++j) before_rad.push_back(robot.position_rad(j));
  robot.clear_faults();
  robot.tick();  // applies the command
  robot.tick();
  double step_share = 0;
  for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
    const double most_Nm = robot.limits().joints[j].effort_max_Nm;
    if (most_Nm > 0) step_share = std::max(step_share, std::abs(robot.plant.written().joints[j].effort_Nm) / most_Nm);
  }
  share = std::max(share, run(robot, 1500));
  double moved_rad = 0;
  for (std::size_t j = 0; j < robot.model.joints.size(); ++j) {
    moved_rad = std::max(moved_rad, std::abs(robot.position_rad(j) - before_rad[j]));
  }
  CHECK(robot.safety.robot_level() <= SafetyLevel::limited);
  CHECK(step_share < 0.02);
  CHECK(moved_rad < 0.1);
  CHECK(share <= 1.0);
  CHECK(robot.broken_promise() == "");
}

TEST_SUITE_END();

}  // namespace contract_tulip_test

#include "control/balance/dcm_step.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "leg_robot.h"
#include "tested_object.h"

namespace dcm_step_test {

using namespace kadans;
using kadans::test::leg_robot;

namespace {

const ObjectOptions feet{{{"left_foot", "l_foot"}, {"right_foot", "r_foot"}}};
const std::vector<std::size_t> legs{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};

// Stands on bent knees, enabled.
struct Bench : kadans::test::TestedObject {
  RobotModel model = leg_robot();
  DcmStep step{{.model = model, .joints = legs, .options = feet}};

  Bench() {
    declare(step, 10);
    for (const std::size_t first : {std::size_t{0}, std::size_t{5}}) {
      joints.joints[first + hip_pitch].position_rad = -0.3;
      joints.joints[first + knee].position_rad = 0.6;
      joints.joints[first + ankle_pitch].position_rad = -0.3;
    }
    status.foot_count = 2;
    status.feet[0].force_N = status.feet[1].force_N = 70;
    set("enabled", 1);
    step.start(input());
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) step.step(input(), computed);
  }
  void push() { status.base.angular_velocity_rad_s = {0, 1.5, 0}; }  // xi 0.2 m ahead
  int claimed() const {
    int count = 0;
    for (const std::size_t joint : legs) count += computed.joints[joint].mode == ActuationMode::effort;
    return count;
  }
};

}  // namespace

TEST_CASE("DcmStep claims nothing while the robot stands") {
  Bench bench;
  bench.ticks(200);
  CHECK(bench.claimed() == 0);
  CHECK(bench.step.plan().state().steps == 0);
}

TEST_CASE("DcmStep claims both legs from its first step on, within their torques") {
  Bench bench;
  bench.ticks(5);
  bench.push();
  for (int tick = 0; tick < 800; ++tick) {
    if (tick == 300) bench.status.base.angular_velocity_rad_s = {};
    bench.ticks(1);
    for (const std::size_t joint : legs) REQUIRE(std::abs(bench.computed.joints[joint].effort_Nm) <= 25);
  }
  CHECK(bench.claimed() == 10);
  CHECK(bench.step.plan().state().steps >= 1);
}

TEST_CASE("DcmStep swings the leg forward and lets the stance leg hold the torso") {
  Bench bench;
  bench.ticks(5);
  bench.push();
  bench.ticks(60);
  REQUIRE(bench.step.plan().state().phase == StepPlan::Phase::swings);
  const std::size_t swing = 5 * (1 - bench.step.plan().state().stance), stance = 5 - swing;
  CHECK(bench.computed.joints[swing + hip_pitch].effort_Nm < 0);
  CHECK(bench.computed.joints[swing + knee].effort_Nm > 0);
  CHECK(bench.computed.joints[stance + ankle_pitch].effort_Nm > 2);  // presses with the toes
}

TEST_CASE("DcmStep lets go when it is disabled, and forgets its step") {
  Bench bench;
  bench.ticks(5);
  bench.push();
  bench.ticks(50);
  REQUIRE(bench.claimed() == 10);
  bench.set("enabled", 0);
  bench.ticks(1);
  CHECK(bench.claimed() == 0);
  bench.status.base.angular_velocity_rad_s = {};
  bench.set("enabled", 1);
  bench.ticks(100);
  CHECK(bench.claimed() == 0);
}

TEST_CASE("DcmStep gives up a robot that falls, or is not measured, until it is enabled anew") {
  Bench bench;
  SUBCASE("falls") { bench.status.base.tilt_rad = 1; }
  SUBCASE("not measured") { bench.joints.joints[3].position_rad = std::numeric_limits<double>::quiet_NaN(); }
  bench.push();
  bench.ticks(50);
  CHECK(bench.claimed() == 0);
  bench.status.base.tilt_rad = 0;
  bench.joints.joints[3].position_rad = 0.6;
  bench.ticks(50);
  CHECK(bench.claimed() == 0);
  bench.set("enabled", 0);
  bench.ticks(1);
  bench.set("enabled", 1);
  bench.ticks(50);
  CHECK(bench.claimed() == 10);
}

TEST_CASE("DcmStep keeps the heading that it began with while the torso turns under it") {
  Bench bench;
  bench.ticks(5);
  bench.push();
  bench.ticks(100);
  const std::size_t swing = 5 * (1 - bench.step.plan().state().stance);
  bench.status.base.yaw_rad = 0.2;
  bench.ticks(1);
  const double turned_Nm = bench.computed.joints[swing + hip_yaw].effort_Nm;
  CHECK(turned_Nm < -5);  // the foot is to land straight
}

TEST_CASE("DcmStep does not allocate") {
  Bench bench;
  bench.push();
  const kadans::testing::AllocationCount heap;
  for (int i = 0; i < 700; ++i) bench.step.step(bench.input(), bench.computed);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(bench.step.plan().state().steps > 0);
}

TEST_CASE("DcmStep needs feet and both legs") {
  const RobotModel model = leg_robot();
  CHECK_THROWS_WITH_AS(DcmStep({.model = model, .joints = legs}), "it needs the option 'left_foot': a foot's link",
                       OptionError);
  CHECK_THROWS_AS(DcmStep({.model = model, .joints = {0, 1, 2, 3, 4}, .options = feet}), std::invalid_argument);
}

}  // namespace dcm_step_test

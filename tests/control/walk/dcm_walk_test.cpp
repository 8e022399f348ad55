#include "control/walk/dcm_walk.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include <doctest/doctest.h>

#include "control/tested_object.h"
#include "kadans/testing/allocation_count.h"
#include "leg_robot.h"

namespace dcm_walk_test {

using namespace kadans;
using kadans::test::leg_robot;

namespace {

const ObjectOptions feet{{{"left_foot", "l_foot"}, {"right_foot", "r_foot"}}};
const std::vector<std::size_t> legs{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
using Phase = WalkPlan::Phase;

// Stands on bent knees; what the object computes moves nothing. The foot that shall swing is off the ground.
struct Bench : kadans::test::TestedObject {
  RobotModel model = leg_robot();
  DcmWalk walk{{.model = model, .joints = legs, .options = feet}};

  Bench() {
    declare(walk, 10);
    for (const std::size_t first : {std::size_t{0}, std::size_t{5}}) {
      joints.joints[first + hip_pitch].position_rad = -0.3;
      joints.joints[first + knee].position_rad = 0.6;
      joints.joints[first + ankle_pitch].position_rad = -0.3;
    }
    status.foot_count = 2;
    status.feet[0].force_N = status.feet[1].force_N = 70;
    walk.start(input());
  }
  void lead(const char* name, double value) {
    const auto id = catalog.setpoints.find(std::string("it.") + name);
    REQUIRE(id);
    set_point(catalog.setpoints[*id].channel, value, 0);
  }
  double reads(const char* name) const {
    SetpointState state;
    CHECK(walk.setpoint_state(catalog.setpoints[*catalog.setpoints.find(std::string("it.") + name)].channel, state));
    return state.value;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      const WalkPlan::State& s = walk.plan().state();
      const bool lands = s.time_s > s.step_s;
      if (s.phase == Phase::steps) {
        status.feet[s.stance].force_N = 140;
        status.feet[1 - s.stance].force_N = lands ? 30 : 0;
      }
      walk.step(input(), computed);
    }
  }
  int claimed() const {
    int count = 0;
    for (const std::size_t joint : legs) count += computed.joints[joint].mode == ActuationMode::effort;
    return count;
  }
};

}  // namespace

TEST_CASE("DcmWalk claims nothing until it is told to go, then both legs within their torques") {
  Bench bench;
  bench.ticks(200);
  CHECK(bench.claimed() == 0);
  CHECK(bench.reads("go") == 0);
  bench.lead("forward_m_s", 0.3);
  bench.lead("go", 1);
  for (int tick = 0; tick < 2000; ++tick) {
    bench.ticks(1);
    REQUIRE(bench.claimed() == 10);
    for (const std::size_t joint : legs) REQUIRE(std::abs(bench.computed.joints[joint].effort_Nm) <= 25);
  }
  CHECK(bench.reads("go") == 1);
  CHECK(bench.walk.plan().state().steps >= 3);
}

TEST_CASE("DcmWalk lets the stance leg bear the robot, and lifts the other") {
  Bench bench;
  bench.lead("go", 1);
  while (bench.walk.plan().state().phase != Phase::steps) bench.ticks(1);
  bench.ticks(100);
  const std::size_t a = 5 * bench.walk.plan().state().stance, b = 5 - a;
  CHECK(bench.computed.joints[b + knee].effort_Nm > 1);                // bends
  CHECK(bench.computed.joints[b + hip_pitch].effort_Nm < 0);           // forward and up
  CHECK(std::abs(bench.computed.joints[a + hip_roll].effort_Nm) > 3);  // the weight beside the hip
}

TEST_CASE("DcmWalk levels the sole of the swinging foot by what hip and knee are, and shortens a leg that lags") {
  const auto targets_rad = [](LegJoint joint, double by_rad) {
    Bench bench;
    bench.lead("forward_m_s", 0.5);
    bench.lead("go", 1);
    while (bench.walk.plan().state().phase != Phase::steps) bench.ticks(1);
    bench.ticks(200);
    const bool left = bench.walk.plan().state().stance == 1;
    bench.joints.joints[(left ? 0 : 5) + joint].position_rad += by_rad;
    bench.ticks(1);
    const std::string side = left ? "l_" : "r_";
    return std::array{bench.signal(side + "knee.target_rad"), bench.signal(side + "ankle_pitch.target_rad")};
  };
  const auto as_it_is = targets_rad(hip_pitch, 0);
  CHECK(targets_rad(hip_pitch, 0.1)[1] == doctest::Approx(as_it_is[1] - 0.1));
  CHECK(targets_rad(knee, -0.1)[1] == doctest::Approx(as_it_is[1] + 0.1));
  CHECK(targets_rad(hip_pitch, -0.3)[0] < as_it_is[0] - 0.002);  // nearer to its foothold, it may be longer
}

TEST_CASE("DcmWalk turns over the foot that bears by no more than that grips") {
  Bench bench;
  bench.lead("go", 1);
  while (bench.walk.plan().state().phase != Phase::steps) bench.ticks(1);
  bench.ticks(20);
  const std::size_t stance = bench.walk.plan().state().stance;
  bench.joints.joints[5 * stance + hip_yaw].velocity_rad_s = -5;  // it is turned, quickly
  const auto turns_Nm = [&](double bears_N, double grip_m) {
    bench.set("yaw_grip_m", grip_m);
    for (int tick = 0; tick < 20; ++tick) {
      bench.status.feet[stance].force_N = bears_N;
      bench.walk.step(bench.input(), bench.computed);
    }
    REQUIRE(bench.walk.plan().state().stance == stance);
    return bench.computed.joints[5 * stance + hip_yaw].effort_Nm;
  };
  CHECK(turns_Nm(140, 0) > 8);  // as its spring has it
  CHECK(turns_Nm(140, 0.035) == doctest::Approx(4.9));
  CHECK(turns_Nm(40, 0.035) == doctest::Approx(1.4));
}

TEST_CASE("DcmWalk lands without a step in torque") {
  const auto most_at_a_landing = [](double fade_s) {
    Bench bench;
    bench.set("fade_s", fade_s);
    bench.lead("go", 1);
    double most_Nm = 0;
    for (int tick = 0; tick < 3000; ++tick) {
      const ActuationFrame before = bench.computed;
      bench.ticks(1);
      if (bench.walk.plan().state().steps == 0 || bench.walk.plan().state().time_s > 0.0015) continue;
      for (const std::size_t joint : legs)
        most_Nm = std::max(most_Nm, std::abs(bench.effort_Nm(joint) - before.joints[joint].effort_Nm));
    }
    CHECK(bench.walk.plan().state().steps > 5);
    return most_Nm;
  };
  CHECK(most_at_a_landing(0.006) < 0.4 * most_at_a_landing(0));
}

TEST_CASE("DcmWalk comes to stand when it shall not go on, carries the robot there, and goes again") {
  Bench bench;
  bench.lead("go", 1);
  bench.ticks(1500);
  REQUIRE(bench.claimed() == 10);
  bench.lead("go", 0);
  bench.ticks(3000);
  CHECK(bench.claimed() == 10);
  CHECK(bench.reads("go") == 0);
  CHECK(bench.walk.plan().state().phase == Phase::bears);
  bench.lead("go", 1);
  bench.ticks(1000);
  CHECK(bench.reads("go") == 1);
  CHECK(bench.walk.plan().state().phase == Phase::steps);
}

TEST_CASE("DcmWalk bears on feet far apart by forces that push nothing to a side") {
  Bench bench;
  for (const std::size_t joint : legs) bench.joints.joints[joint].position_rad = 0;
  bench.joints.joints[hip_roll].position_rad = 0.3;  // both feet outward
  bench.joints.joints[5 + hip_roll].position_rad = -0.3;
  bench.set("sway_gain", 0);  // the load stays in the middle
  bench.lead("go", 1);
  bench.ticks(1);
  REQUIRE(bench.walk.plan().state().phase == Phase::sways);
  const double out_m = (kadans::test::thigh_m + kadans::test::shank_m) * std::sin(0.3);
  const double upward_Nm = 9.81 * bench.model.mass_kg() / 2 * out_m;  // about the hip
  bench.set("fade_s", 0);
  bench.set("height_N_per_m", 0);
  bench.set("height_Ns_per_m", 0);
  bench.ticks(1);
  CHECK(std::abs(bench.computed.joints[hip_roll].effort_Nm) > 0.8 * upward_Nm);
  CHECK(bench.computed.joints[hip_roll].effort_Nm == doctest::Approx(-bench.computed.joints[5 + hip_roll].effort_Nm));
}

TEST_CASE("DcmWalk gives up a robot that falls, or is not measured, until it is told to stop and to go again") {
  Bench bench;
  bench.lead("go", 1);
  bench.ticks(100);
  REQUIRE(bench.claimed() == 10);
  SUBCASE("falls") { bench.status.base.tilt_rad = 1; }
  SUBCASE("not measured") { bench.joints.joints[3].position_rad = std::numeric_limits<double>::quiet_NaN(); }
  bench.ticks(1);
  CHECK(bench.claimed() == 0);
  bench.status.base.tilt_rad = 0;
  bench.joints.joints[3].position_rad = 0.6;
  bench.ticks(50);
  CHECK(bench.claimed() == 0);
  bench.lead("go", 0);
  bench.ticks(1);
  bench.lead("go", 1);
  bench.ticks(50);
  CHECK(bench.claimed() == 10);
}

TEST_CASE("DcmWalk goes on by the odometry from where it is told to be, also over a reset") {
  Bench bench;
  OdometryStatus& odometry = bench.status.odometry;
  odometry = {.x_m = 5, .y_m = 0, .heading_rad = 0};
  bench.ticks(1);
  bench.lead("x_m", 2);
  bench.lead("y_m", 1);
  bench.lead("heading_rad", std::numbers::pi / 2);
  bench.lead("go", 1);
  bench.ticks(5);
  CHECK(bench.reads("x_m") == doctest::Approx(2));
  CHECK(bench.reads("heading_rad") == doctest::Approx(std::numbers::pi / 2));
  odometry.x_m += 0.03;  // forward, which is to the left of where its x points
  odometry.heading_rad += 0.1;
  bench.ticks(1);
  CHECK(bench.reads("y_m") == doctest::Approx(1.03));
  CHECK(bench.reads("x_m") == doctest::Approx(2));
  CHECK(bench.reads("heading_rad") == doctest::Approx(std::numbers::pi / 2 + 0.1));
  odometry = {.resets = 1};
  bench.ticks(1);
  CHECK(bench.reads("y_m") == doctest::Approx(1.03));
  odometry.y_m = 0.02;
  bench.ticks(1);
  CHECK(bench.reads("x_m") == doctest::Approx(2 - 0.02 * std::cos(0.1)));
}

TEST_CASE("DcmWalk does not allocate") {
  Bench bench;
  bench.lead("go", 1);
  bench.ticks(1);
  const kadans::testing::AllocationCount heap;
  bench.ticks(1500);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(bench.walk.plan().state().steps > 2);
}

TEST_CASE("DcmWalk needs feet and both legs") {
  const RobotModel model = leg_robot();
  CHECK_THROWS_WITH_AS(DcmWalk({.model = model, .joints = legs}), "it needs the option 'left_foot': a foot's link",
                       OptionError);
  CHECK_THROWS_AS(DcmWalk({.model = model, .joints = {0, 1, 2, 3, 4}, .options = feet}), std::invalid_argument);
}

}  // namespace dcm_walk_test

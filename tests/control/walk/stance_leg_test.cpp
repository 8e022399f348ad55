#include "control/walk/stance_leg.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/tested_object.h"
#include "kadans/testing/allocation_count.h"
#include "leg_robot.h"

namespace stance_leg_test {

using namespace kadans;
using kadans::test::leg_robot;
using kadans::test::TestedObject;

namespace {

constexpr double weight_N = 9.81 * (10 + 2 * 2.5), leg_m = kadans::test::thigh_m + kadans::test::shank_m;
constexpr std::size_t hip_roll = 1, hip_pitch = 2, knee = 3, ankle_pitch = 4;
const ObjectOptions left_foot{{{"foot", "l_foot"}}};

// The robot is where a test puts it: what the object computes moves nothing.
struct Bench : TestedObject {
  Bench() {
    declare(object, 10);
    set("sole_m", 0);
    set("grip", 2);
  }
  void settle() {
    object.start(input());
    for (int i = 0; i < 100; ++i) object.step(input(), computed);
  }
  void lean(double pitch_rad, double roll_rad = 0, double rate_rad_s = 0) {
    status.base.pitch_rad = pitch_rad;
    status.base.roll_rad = roll_rad;
    status.base.angular_velocity_rad_s = {rate_rad_s, rate_rad_s, 0};
    settle();
  }
  const Vec3& force_N() const { return object.state().force_N; }
  const Vec3& com_m() const { return object.state().com_m; }

  RobotModel model = leg_robot();
  StanceLeg object{{.model = model, .joints = {1, 2, 3, 4}, .options = left_foot}};
};

}  // namespace

TEST_CASE("A stance leg bears the whole weight by a force from its foot through the centre of mass") {
  Bench bench;
  bench.lean(0.05);
  CHECK(bench.com_m()[1] == doctest::Approx(-0.09));  // the middle is right of the left foot
  CHECK(bench.force_N()[2] == doctest::Approx(weight_N));
  CHECK(bench.force_N()[0] / weight_N == doctest::Approx(bench.com_m()[0] / bench.com_m()[2]));
  CHECK(bench.force_N()[1] / weight_N == doctest::Approx(bench.com_m()[1] / bench.com_m()[2]));
  CHECK(bench.effort_Nm(ankle_pitch) == doctest::Approx(0));
  bench.lean(0);
  CHECK(bench.effort_Nm(hip_roll) == doctest::Approx(-leg_m * bench.force_N()[1]));  // keeps the pelvis level
  CHECK(bench.effort_Nm(knee) == doctest::Approx(0));                                // of a straight leg
}

TEST_CASE("A stance leg presses where it is told, by its ankle") {
  Bench bench;
  bench.set("pressure_x_m", 0.03);
  bench.lean(0);
  CHECK(bench.effort_Nm(ankle_pitch) == doctest::Approx(0.03 * weight_N));
  CHECK(bench.force_N()[0] < 0);  // which pushes the robot back
}

TEST_CASE("A stance leg rights the trunk by the attitude and its rate, and pushes the ground for it") {
  Bench bench;
  bench.set("upright_Nm_per_rad", 100);
  bench.set("upright_Nms_per_rad", 6);
  bench.set("level_Nm_per_rad", 150);
  bench.set("level_Nms_per_rad", 10);
  bench.set("pitch_rad", 0.02);
  bench.set("roll_rad", 0.01);
  bench.lean(0.05, -0.03, 0.2);
  const StanceLeg::State& s = bench.object.state();
  CHECK(s.turn_y_Nm == doctest::Approx(-100 * 0.03 - 6 * 0.2));
  CHECK(s.turn_x_Nm == doctest::Approx(150 * 0.04 - 10 * 0.2));
  CHECK(s.force_N[0] == doctest::Approx((weight_N * s.com_m[0] - s.turn_y_Nm) / s.com_m[2]));
  CHECK(s.force_N[1] == doctest::Approx((weight_N * s.com_m[1] + s.turn_x_Nm) / s.com_m[2]));
  const double righting_Nm = bench.effort_Nm(hip_pitch);
  bench.set("upright_Nm_per_rad", 0);
  bench.set("upright_Nms_per_rad", 0);
  bench.lean(0.05, -0.03, 0.2);
  CHECK(righting_Nm > bench.effort_Nm(hip_pitch));  // a thigh that is turned back under a trunk that is turned back
}

TEST_CASE("A stance leg asks no more of the ground than its grip") {
  Bench bench;
  bench.set("grip", 0.1);
  bench.lean(0.3, 0.4);
  CHECK(bench.force_N()[0] == doctest::Approx(0.1 * weight_N));
  CHECK(bench.force_N()[1] == doctest::Approx(-0.1 * weight_N));
}

TEST_CASE("A stance leg takes the load over in rise_s, from no torque") {
  Bench bench;
  bench.set("rise_s", 0.02);
  bench.lean(0);
  const double whole_Nm = bench.effort_Nm(hip_roll);
  bench.object.start(bench.input());
  double last_Nm = 0;
  for (int i = 1; i <= 20; ++i) {
    bench.object.step(bench.input(), bench.computed);
    CHECK(bench.effort_Nm(hip_roll) - last_Nm == doctest::Approx(whole_Nm / 20));
    last_Nm = bench.effort_Nm(hip_roll);
  }
  CHECK(last_Nm == doctest::Approx(whole_Nm));
}

TEST_CASE(
    "A stance leg gives no torque when something is not measured, or the robot lies, and never more than nine tenths") {
  Bench bench;
  bench.set("level_Nm_per_rad", 2000);
  bench.lean(0, 0.4);
  CHECK(std::abs(bench.effort_Nm(hip_roll)) == doctest::Approx(0.9 * 25));
  bench.joints.joints[knee].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.object.step(bench.input(), bench.computed);
  for (std::size_t joint = hip_roll; joint <= ankle_pitch; ++joint) CHECK(bench.effort_Nm(joint) == 0);
  bench.joints.joints[knee].position_rad = 0;
  bench.lean(1.57);
  for (std::size_t joint = hip_roll; joint <= ankle_pitch; ++joint) CHECK(bench.effort_Nm(joint) == 0);
}

TEST_CASE("A stance leg does not allocate") {
  Bench bench;
  const ControlInput input = bench.input();
  const kadans::testing::AllocationCount heap;
  bench.object.start(input);
  bench.object.step(input, bench.computed);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("A stance leg needs a foot, and joints that lead to it") {
  const RobotModel model = leg_robot();
  CHECK_THROWS_WITH_AS(StanceLeg({.model = model, .joints = {1}}), "it needs the option 'foot': the link that stands",
                       OptionError);
  CHECK_THROWS_WITH_AS(StanceLeg({.model = model, .joints = {6}, .options = left_foot}),
                       "joint r_hip_roll does not lead to the foot l_foot", std::invalid_argument);
}

}  // namespace stance_leg_test

#include "control/balance/stance.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "control/walk/biped.h"
#include "kadans/testing/allocation_count.h"

namespace stance_test {

using namespace kadans;
using kadans::test::biped;
using kadans::test::biped_feet;

namespace {

constexpr double weight_N = kadans::test::biped_weight_N, com_height_m = kadans::test::biped_com_height_m;

struct Bench : kadans::test::BalanceBench<Stance> {
  Bench() {
    set("share", 1);
    set("sole_m", 0);
    set("pull_x", 2);
    set("need", 1);
  }
};

}  // namespace

TEST_CASE("Stance presses beyond where the robot is going, each ankle with its share of the weight") {
  Bench bench;
  bench.lean(0.05);
  const double error_m = com_height_m * std::sin(0.05);
  CHECK(bench.state().dcm_x_m == doctest::Approx(error_m));
  CHECK(bench.state().cop_x_m == doctest::Approx(2 * error_m));
  CHECK(bench.ankle_Nm() == doctest::Approx(weight_N * error_m));  // half of the weight at twice the error
  CHECK(bench.ankle_Nm(3) == doctest::Approx(bench.ankle_Nm()));
  bench.lean(0, 0, 0.2);
  const double velocity_m_s = 0.2 * com_height_m;
  CHECK(bench.state().dcm_x_m == doctest::Approx(velocity_m_s * std::sqrt(com_height_m / 9.81)).epsilon(1e-3));
}

TEST_CASE("Stance never presses before the toes or behind the heels, whatever the robot does") {
  Bench bench;
  bench.set("toe_m", 0.1);
  bench.set("heel_m", 0.05);
  bench.lean(0.3);
  CHECK(bench.state().cop_x_m == 0.1);
  CHECK(bench.ankle_Nm() == doctest::Approx(weight_N / 2 * 0.1));
  bench.lean(-0.3);
  CHECK(bench.state().cop_x_m == -0.05);
  CHECK(bench.ankle_Nm() == doctest::Approx(-weight_N / 2 * 0.05));
}

TEST_CASE("Stance follows xi by its law, and by what is measured as far as that is trusted") {
  Bench bench;
  bench.set("turn_max_Nm", 0);
  bench.set("trust_per_s", 80);
  const double at_m = com_height_m * std::sin(0.05);
  bench.status.foot_count = 2;
  for (FootStatus& foot : bench.status.feet) foot = {.contact = true, .force_N = 60, .cop_x_m = at_m};
  bench.lean(0.05);
  CHECK(bench.state().dcm_x_m == doctest::Approx(at_m));
  for (int i = 0; i < 200; ++i) {  // velocities that shake by 0.07 m of xi
    bench.status.base.angular_velocity_rad_s[1] = i % 2 == 0 ? 0.5 : -0.5;
    bench.step();
    REQUIRE(std::abs(bench.state().dcm_x_m - at_m) < 0.008);
  }
  bench.status.base.angular_velocity_rad_s[1] = 0;
  bench.set("trust_per_s", 0);
  for (FootStatus& foot : bench.status.feet) foot.cop_x_m = 0;
  const double before_m = bench.state().dcm_x_m;
  for (int i = 0; i < 100; ++i) bench.step();
  CHECK(bench.state().dcm_x_m ==
        doctest::Approx(before_m * std::exp(0.1 * std::sqrt(9.81 / com_height_m))).epsilon(0.01));
}

TEST_CASE("Stance bows the trunk with what the soles cannot do, and pushes the hips back with it") {
  Bench bench;
  bench.set("toe_m", 0.05);
  bench.set("grip", 2);
  bench.lean(0.15);
  const double dcm_m = com_height_m * std::sin(0.15);
  CHECK(bench.state().turn_y_Nm == doctest::Approx(weight_N * (dcm_m - 0.05)));
  const double force_N = (weight_N * (dcm_m - 0.05) - bench.state().turn_y_Nm) / (com_height_m * std::cos(0.15));
  CHECK(bench.state().force_N[0] == doctest::Approx(force_N));
  const double bowing_Nm = bench.hip_Nm();
  bench.set("turn_max_Nm", 0);
  bench.lean(0.15);
  CHECK(bench.state().turn_y_Nm == 0);
  CHECK(bowing_Nm < bench.hip_Nm());  // a hip that bows the trunk pulls it towards the thigh
}

TEST_CASE("Stance rights the trunk only as far as the soles make up for it") {
  Bench bench;
  bench.set("upright_Nm_per_rad", 200);
  bench.set("toe_m", 0.06);
  bench.lean(0.05);
  const double dcm_m = com_height_m * std::sin(0.05);
  CHECK(bench.state().turn_y_Nm == doctest::Approx(weight_N * (dcm_m - 0.06)));  // of -10 Nm that it would have
  CHECK(bench.state().cop_x_m == 0.06);
  CHECK(bench.state().beyond_x_m == doctest::Approx(dcm_m));  // twice the error was wanted
  bench.set("toe_m", 0.3);
  bench.lean(0.05);
  CHECK(bench.state().turn_y_Nm == doctest::Approx(-10));
  CHECK(bench.state().cop_x_m == doctest::Approx(2 * dcm_m + 10 / weight_N));
}

TEST_CASE("Stance pushes off to where it is told to rest, beside the middle, and bears there at rest") {
  Bench bench;
  bench.set("pull_y", 2);
  bench.set("offset_y_m", 0.02);
  bench.lean(0);
  CHECK(bench.state().cop_y_m == doctest::Approx(-0.02));
  CHECK(bench.state().left < 0.5);
  bench.lean(0, -std::asin(0.02 / com_height_m));
  CHECK(bench.state().dcm_y_m == doctest::Approx(0.02).epsilon(0.01));
  CHECK(bench.state().cop_y_m == doctest::Approx(0.02).epsilon(0.01));
  CHECK(bench.state().left > 0.5);
}

TEST_CASE("Stance puts the weight on the foot on the side that the robot falls to") {
  Bench bench;
  bench.lean(0, -0.02);  // to the left
  CHECK(bench.state().cop_y_m == doctest::Approx(2 * com_height_m * std::sin(0.02)));
  CHECK(bench.state().left == doctest::Approx(0.5 + bench.state().cop_y_m / (0.2 * std::cos(0.02))));
  bench.lean(0, -0.2);
  CHECK(bench.state().left == 1);
  CHECK(bench.ankle_Nm(3) == doctest::Approx(0));
  bench.lean(0, 0.2);
  CHECK(bench.state().left == 0);
}

TEST_CASE("Stance reaches no further with a foot set ahead than that foot bears") {
  Bench bench;
  bench.set("toe_m", 0.1);
  bench.joints.joints[0].position_rad = -0.2;  // left leg forward
  bench.joints.joints[2].position_rad = 0.2;
  const double ahead_m = std::sin(0.2);  // both legs of half a metre
  bench.lean(0.3);
  CHECK(bench.state().cop_x_m == doctest::Approx(0.1));
  bench.lean(0.3, -0.2);
  const double stride_m = ahead_m * std::cos(0.3);
  CHECK(bench.state().cop_x_m == doctest::Approx(0.1 + stride_m / 2).epsilon(0.02));
}

TEST_CASE("Stance asks no more of the ground than its grip, and lifts the robot to its height") {
  Bench bench;
  bench.set("grip", 0.1);
  bench.set("toe_m", 0.05);
  bench.set("turn_max_Nm", 200);
  bench.set("need", 3);
  bench.lean(0.2);
  CHECK(std::abs(bench.state().force_N[0]) == doctest::Approx(0.1 * bench.state().force_N[2]));
  bench.set("height_m", com_height_m + 0.01);
  bench.set("height_N_per_m", 1000);
  bench.lean(0);
  CHECK(bench.state().force_N[2] == doctest::Approx(weight_N + 10));
  bench.set("lift_max", 0.05);
  bench.lean(0);
  CHECK(bench.state().force_N[2] == doctest::Approx(1.05 * weight_N));
}

TEST_CASE("Stance comes in from no torque, as far as it is told, through a low pass") {
  Bench bench;
  bench.lean(0.05);
  const double whole_Nm = bench.ankle_Nm();
  bench.object.start(bench.input());
  bench.step();
  CHECK(bench.ankle_Nm() == doctest::Approx(0.005 * whole_Nm));
  bench.set("smooth_s", 0.01);
  bench.settle();
  bench.status.base.pitch_rad = -0.05;
  bench.step();
  CHECK(bench.ankle_Nm() == doctest::Approx(0.8 * whole_Nm).epsilon(0.02));  // a tenth of the way
  bench.set("share", 0);
  bench.settle();
  CHECK(bench.ankle_Nm() == 0);
}

TEST_CASE("Stance gives no torque when something is not measured, or the robot lies") {
  Bench bench;
  bench.lean(0.05);
  bench.joints.joints[1].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.joints.joints[0].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.step();
  CHECK(bench.ankle_Nm() == 0);
  CHECK(bench.hip_Nm() == 0);
  bench.joints.joints[0].position_rad = bench.joints.joints[1].position_rad = 0;
  bench.lean(1.57);
  CHECK(bench.ankle_Nm() == 0);
}

TEST_CASE("Stance does not allocate") {
  Bench bench;
  const ControlInput input = bench.input();
  const kadans::testing::AllocationCount heap;
  bench.object.start(input);
  bench.object.step(input, bench.computed);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("Stance needs feet, and joints of legs or arms") {
  const RobotModel model = biped();
  CHECK_THROWS_WITH_AS(Stance({.model = model, .joints = {0}}), "it needs the option 'left_foot': a foot's link",
                       OptionError);
  RobotModel other = biped();
  other.links.push_back(kadans::test::biped_link("wing", 1, 0));
  other.joints.push_back(kadans::test::biped_joint("l_wing", 0, {}));
  CHECK_NOTHROW(
      Stance({.model = other, .joints = {4}, .options = biped_feet}));  // it swings about y as a shoulder does
  other.joints.back().axis = {1, 0, 0};
  CHECK_THROWS_AS(Stance({.model = other, .joints = {4}, .options = biped_feet}), std::invalid_argument);
}

}  // namespace stance_test

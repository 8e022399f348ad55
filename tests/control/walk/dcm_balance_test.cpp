#include "control/balance/dcm_balance.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "biped.h"
#include "kadans/testing/allocation_count.h"

namespace dcm_balance_test {

using namespace kadans;
using kadans::test::biped;
using kadans::test::biped_feet;

namespace {

constexpr double weight_N = kadans::test::biped_weight_N, com_height_m = kadans::test::biped_com_height_m;

struct Bench : kadans::test::BalanceBench<DcmBalance> {
  explicit Bench(RobotModel robot = biped()) : BalanceBench(std::move(robot)) {
    set("offset_x_m", 0);
    set("hip_Nm_per_m", 300);
  }
};

}  // namespace

TEST_CASE("DcmBalance presses with the toes against a lean forward, each ankle with half of it") {
  Bench bench;
  bench.lean(0.05);
  const double error_m = com_height_m * std::sin(0.05);
  CHECK(bench.state().dcm_x_m == doctest::Approx(error_m));
  CHECK(bench.ankle_Nm() == doctest::Approx(weight_N * error_m / 2));
  CHECK(bench.ankle_Nm(3) == bench.ankle_Nm());
  bench.lean(-0.05);
  CHECK(bench.ankle_Nm() == doctest::Approx(-weight_N * error_m / 2));
}

TEST_CASE("DcmBalance counts where the robot is going, not only where it is") {
  Bench bench;
  bench.lean(0, 0, 0.2);
  const double velocity_m_s = 0.2 * com_height_m;
  CHECK(bench.state().com_x_m == doctest::Approx(0));
  CHECK(bench.state().dcm_x_m == doctest::Approx(velocity_m_s * std::sqrt(com_height_m / 9.81)).epsilon(1e-3));
}

TEST_CASE("DcmBalance keeps its ankles within their bound, and bows only beyond their reach") {
  Bench bench;
  bench.set("ankle_max_Nm", 3);
  bench.lean(0.1);
  CHECK(bench.ankle_Nm() == 3);
  CHECK(bench.hip_Nm() == 0);
  bench.lean(0.2);
  CHECK(bench.hip_Nm() == doctest::Approx(-300 * (com_height_m * std::sin(0.2) - 0.1)));
  bench.lean(-0.2);
  CHECK(bench.hip_Nm() == doctest::Approx(300 * (com_height_m * std::sin(0.2) - 0.06)));
  bench.lean(0.3);
  CHECK(bench.hip_Nm() == -20);  // the joint's own limit
}

TEST_CASE("DcmBalance comes in from no torque, and goes as far as it is told") {
  Bench bench;
  bench.lean(0.05);
  const double whole_Nm = bench.ankle_Nm();
  bench.object.start(bench.input());
  bench.step();
  CHECK(bench.ankle_Nm() == doctest::Approx(0.005 * whole_Nm));
  bench.set("share", 0.5);
  bench.lean(0.05);
  CHECK(bench.ankle_Nm() == doctest::Approx(whole_Nm / 2));
}

TEST_CASE("DcmBalance passes its torques through a low pass when it is told to") {
  Bench bench;
  bench.lean(0.05);
  const double whole_Nm = bench.ankle_Nm();
  bench.set("smooth_s", 0.01);
  bench.lean(0.05);
  CHECK(bench.ankle_Nm() == doctest::Approx(whole_Nm).epsilon(0.01));
  bench.lean(-0.05);
  bench.status.base.pitch_rad = 0.05;
  bench.step();
  CHECK(bench.ankle_Nm() == doctest::Approx(-0.8 * whole_Nm).epsilon(0.01));  // a tenth of the way
}

TEST_CASE("DcmBalance gives no torque when something is not measured, or the robot lies") {
  Bench bench;
  bench.lean(0.05);
  bench.joints.joints[1].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.step();
  CHECK(bench.ankle_Nm() == 0);
  CHECK(bench.hip_Nm() == 0);
  bench.joints.joints[1].position_rad = 0;
  bench.lean(1.57);
  CHECK(bench.ankle_Nm() == 0);
}

TEST_CASE("DcmBalance turns a joint about -y the other way") {
  RobotModel other = biped();
  other.joints[1].axis = {0, -1, 0};
  Bench plain, turned(std::move(other));
  plain.lean(0.05);
  turned.lean(0.05);
  CHECK(turned.ankle_Nm() == -plain.ankle_Nm());
  CHECK(turned.ankle_Nm(3) == plain.ankle_Nm(3));
}

TEST_CASE("DcmBalance does not allocate") {
  Bench bench;
  const ControlInput input = bench.input();
  const kadans::testing::AllocationCount heap;
  bench.object.start(input);
  bench.object.step(input, bench.computed);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("DcmBalance needs feet, and joints that have a part in balance") {
  const RobotModel model = biped();
  CHECK_THROWS_WITH_AS(DcmBalance({.model = model, .joints = {0}}), "it needs the option 'left_foot': a foot's link",
                       OptionError);
  RobotModel other = biped();
  other.joints[0].name = "l_wing";  // names do not matter
  CHECK_NOTHROW(DcmBalance({.model = other, .joints = {0}, .options = biped_feet}));
  other.joints[0].axis = {0, 0, 1};
  CHECK_THROWS_AS(DcmBalance({.model = other, .joints = {0}, .options = biped_feet}), std::invalid_argument);
}

}  // namespace dcm_balance_test

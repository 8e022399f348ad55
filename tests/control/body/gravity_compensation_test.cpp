#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <doctest/doctest.h>

#include "arm_bench.h"
#include "control/made_objects.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;
using kadans::test::ArmBench;

namespace {

// Of the shoulder, both links straight: (2 * 0.15 + 1 * 0.45 + 0.1 * 0.6) kg m.
constexpr double straight_Nm = 9.81 * 0.81;

}  // namespace

TEST_CASE("GravityCompensation lets an arm stay wherever it is left") {
  for (const double shoulder_rad : {-1.5, 0.4, 2.0}) {
    ArmBench bench(make_gravity_compensation);
    bench.place(shoulder_rad, 0.8);
    bench.start();
    bench.run(2000);
    CHECK(bench.position_rad(0) == doctest::Approx(shoulder_rad).epsilon(1e-3));
    CHECK(bench.position_rad(1) == doctest::Approx(0.8).epsilon(1e-3));
  }
}

TEST_CASE("GravityCompensation follows the joints between two runs of its high level") {
  ArmBench bench(make_gravity_compensation);
  bench.place(0.5, 0);
  bench.start();
  bench.run(300);
  bench.joints.joints[0].position_rad += 0.05;  // without the high level
  bench.object->step(bench.input(), bench.computed);
  const double expected_Nm = straight_Nm * std::sin(bench.position_rad(0));
  CHECK(bench.effort_Nm(0) == doctest::Approx(expected_Nm).epsilon(2e-3));
  CHECK(bench.effort_Nm(0) - straight_Nm * std::sin(0.5) ==
        doctest::Approx(straight_Nm * 0.05 * std::cos(0.5)).epsilon(0.05));
}

TEST_CASE("GravityCompensation turns with the base") {
  ArmBench bench(make_gravity_compensation);
  bench.place(0, 0);
  bench.start();
  bench.snapshot.status.base.orientation = from_axis_angle({0, 1, 0}, 0.6);
  bench.run(300);
  bench.place(0, 0);
  bench.joints.joints[0].velocity_rad_s = bench.joints.joints[1].velocity_rad_s = 0;
  bench.update();
  bench.object->step(bench.input(), bench.computed);
  CHECK(bench.effort_Nm(0) == doctest::Approx(straight_Nm * std::sin(0.6)).epsilon(1e-3));
}

TEST_CASE("GravityCompensation takes over without a step in torque, and reaches a new gain without one") {
  ArmBench bench(make_gravity_compensation);
  bench.place(0.9, 0.3);
  bench.written.joints[0].effort_Nm = bench.computed.joints[0].effort_Nm = -6;
  bench.start();
  CHECK(kadans::test::largest_step(bench, 400) < 0.02);
  bench.set("gain", 0.5);
  CHECK(kadans::test::largest_step(bench, 400) < 0.02);
  CHECK(bench.signal("gain") == 0.5);
}

TEST_CASE("GravityCompensation gives a joint whose drive was off all its torque at once, where that is asked") {
  const auto first_Nm = [](const char* from_off, ActuationMode before) {
    ArmBench bench(make_gravity_compensation,
                   ObjectOptions(std::map<std::string, std::string>{{"from_off", from_off}}));
    bench.place(0.9, 0);
    bench.written.joints[0] = {.effort_Nm = before == ActuationMode::off ? 0.0 : -2.0, .mode = before};
    bench.start();
    bench.update();
    bench.object->step(bench.input(), bench.computed);
    return bench.effort_Nm(0);
  };
  const double whole_Nm = straight_Nm * std::sin(0.9);
  CHECK(first_Nm("at_once", ActuationMode::off) == doctest::Approx(whole_Nm).epsilon(1e-6));
  CHECK(first_Nm("at_once", ActuationMode::effort) == doctest::Approx(-2));
  CHECK(std::abs(first_Nm("fade", ActuationMode::off)) < 0.1);
  CHECK_THROWS_WITH_AS(first_Nm("now", ActuationMode::off), "from_off is 'now', must be fade or at_once", OptionError);
}

TEST_CASE("GravityCompensation limits its torque and says so") {
  ArmBench bench(make_gravity_compensation);
  bench.place(1.5, 0);
  bench.set("shoulder.effort_max_Nm", 2);
  bench.start();
  bench.run(10);
  CHECK(bench.effort_Nm(0) == 2);
  CHECK(bench.signal("shoulder.saturated") == 1);
  CHECK(bench.signal("elbow.saturated") == 0);
}

TEST_CASE("GravityCompensation does not hide a joint that is not measured, nor let it spoil the other one") {
  ArmBench bench(make_gravity_compensation);
  bench.place(0.9, 0.3);
  bench.start();
  bench.run(50);
  const double before_Nm = bench.effort_Nm(1);
  bench.joints.joints[0].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.update();
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isnan(bench.effort_Nm(0)));
  CHECK(bench.effort_Nm(1) == doctest::Approx(before_Nm).epsilon(0.01));
  bench.joints.joints[0].position_rad = 0.9;
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isfinite(bench.effort_Nm(0)));
}

TEST_CASE("GravityCompensation allocates nothing in its low level, nor in its high level") {
  ArmBench bench(make_gravity_compensation);
  const kadans::testing::AllocationCount heap;
  bench.start();
  bench.object->step(bench.input(), bench.computed);
  bench.update();
  bench.object->step(bench.input(), bench.computed);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}

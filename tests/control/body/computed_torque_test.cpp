#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "arm_bench.h"
#include "control/made_objects.h"
#include "kadans/testing/allocation_count.h"

namespace computed_torque_test {

using namespace kadans;
using kadans::test::ArmBench;

namespace {

constexpr double w_rad_s = 20;  // natural frequency, critically damped
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();

ArmBench tuned(double ki_Nm_per_rads = 0) {
  ArmBench bench(make_computed_torque);
  for (const std::string joint : {"shoulder.", "elbow."}) {
    bench.set(joint + "kp_per_s2", w_rad_s * w_rad_s);
    bench.set(joint + "kd_per_s", 2 * w_rad_s);
  }
  bench.set("shoulder.ki_Nm_per_rads", ki_Nm_per_rads);
  bench.set("elbow.ki_Nm_per_rads", ki_Nm_per_rads / 10);
  return bench;
}

}  // namespace

TEST_CASE("ComputedTorque gives an error the same decay in every pose, and leaves the other joint alone") {
  for (const double elbow_rad : {0.0, 1.0, -2.0}) {
    CAPTURE(elbow_rad);
    ArmBench bench = tuned();
    bench.place(0.7, elbow_rad);
    bench.start();
    bench.run(300);
    bench.set_point("shoulder.position_rad", 0.8, 0);
    bench.run(2);  // until the torque acts
    const double began_rad = 0.8 - bench.position_rad(0);
    bench.run(100);
    const double t_s = 0.1;
    const double expected_rad = began_rad * (1 + w_rad_s * t_s) * std::exp(-w_rad_s * t_s);
    CHECK(0.8 - bench.position_rad(0) == doctest::Approx(expected_rad).epsilon(0.05));
    CHECK(std::abs(bench.position_rad(1) - elbow_rad) < 0.001);
  }
}

TEST_CASE("ComputedTorque follows a fast motion of both joints within three milliradians") {
  ArmBench bench = tuned();
  bench.place(0.2, 0.1);
  bench.start();
  bench.run(300);
  bench.set_point("shoulder.position_rad", 1.4, 0.8);
  bench.set_point("elbow.position_rad", -1.2, 0.8);
  CHECK(bench.motion_remaining_s() == 0.8);
  double worst_rad = 0;
  for (int i = 0; i < 1000; ++i) {
    bench.tick();
    worst_rad =
        std::max({worst_rad, std::abs(bench.signal("shoulder.error_rad")), std::abs(bench.signal("elbow.error_rad"))});
  }
  CHECK(worst_rad < 0.003);
  CHECK(bench.position_rad(0) == doctest::Approx(1.4).epsilon(1e-3));
}

TEST_CASE("ComputedTorque takes over at rest, in motion and under a strange load without a step in torque") {
  for (const double velocity_rad_s : {0.0, 2.0}) {
    for (const double load_Nm : {0.0, 8.0}) {
      for (const double ki_Nm_per_rads : {0.0, 100.0}) {
        CAPTURE(velocity_rad_s);
        CAPTURE(load_Nm);
        CAPTURE(ki_Nm_per_rads);
        ArmBench bench = tuned(ki_Nm_per_rads);
        bench.place(0.5, 0.5);
        bench.load_Nm = load_Nm;
        bench.written.joints[0].effort_Nm -= load_Nm;
        bench.computed = bench.written;
        bench.joints.joints[0].velocity_rad_s = velocity_rad_s;
        bench.start();
        CHECK(kadans::test::largest_step(bench, 400) < 0.02);
        CHECK(bench.signal("model_age_s") < 0.0101);
      }
    }
  }
}

TEST_CASE("ComputedTorque carries with its integral what the model does not know of") {
  ArmBench bench = tuned(500);
  bench.place(0.5, 0.5);
  bench.start();
  bench.load_Nm = 5;
  bench.run(3000);
  CHECK(std::abs(bench.signal("shoulder.error_rad")) < 1e-4);
  CHECK(bench.signal("shoulder.integral_Nm") == doctest::Approx(-5).epsilon(0.01));
}

TEST_CASE("ComputedTorque limits its torque, says so, and does not wind up meanwhile") {
  ArmBench bench = tuned(500);
  bench.place(0, 0);
  bench.set("shoulder.effort_max_Nm", 4);
  bench.start();
  bench.run(50);
  bench.set_point("shoulder.position_rad", 2.5, 0);
  const double integral_Nm = bench.signal("shoulder.integral_Nm");
  bench.run(200);
  CHECK(bench.effort_Nm(0) == 4);
  CHECK(bench.signal("shoulder.saturated") == 1);
  CHECK(bench.signal("elbow.saturated") == 0);
  CHECK(bench.signal("shoulder.integral_Nm") == doctest::Approx(integral_Nm));
}

TEST_CASE("ComputedTorque keeps to the last model while the high level is silent, and says how old it is") {
  ArmBench bench = tuned();
  bench.place(0.5, 0.5);
  bench.start();
  bench.run(300);
  bench.high_level = false;
  bench.set_point("shoulder.position_rad", 0.6, 0.3);
  bench.run(1000);
  CHECK(bench.signal("model_age_s") == doctest::Approx(1.009));
  CHECK(bench.position_rad(0) == doctest::Approx(0.6).epsilon(0.03));
}

TEST_CASE("ComputedTorque does not hide a joint that is not measured, nor let it spoil the other one") {
  ArmBench bench = tuned();
  bench.place(0.5, 0.5);
  bench.start();
  bench.run(50);
  const double before_Nm = bench.effort_Nm(1), before_rad = bench.position_rad(0);
  bench.joints.joints[0].position_rad = not_measured;
  bench.update();
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isnan(bench.effort_Nm(0)));
  CHECK(bench.effort_Nm(1) == doctest::Approx(before_Nm).epsilon(0.01));
  bench.joints.joints[0].position_rad = before_rad + 0.2;
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isfinite(bench.effort_Nm(0)));
  CHECK(bench.signal("shoulder.error_rad") == doctest::Approx(0));  // taken over where it is now
}

TEST_CASE("ComputedTorque refuses a passive joint") {
  const RobotModel model = kadans::test::arm();
  CHECK_THROWS_WITH_AS(make_computed_torque({model, {2}}), "joint spin is passive: it has no motor to control",
                       std::invalid_argument);
}

TEST_CASE("ComputedTorque allocates nothing in its low level, nor in its high level") {
  ArmBench bench = tuned();
  bench.place(0.5, 0.5);
  const kadans::testing::AllocationCount heap;
  bench.start();
  bench.object->step(bench.input(), bench.computed);
  bench.update();
  bench.object->follow(0, {.value = 0.3, .velocity = 0.2});
  bench.object->step(bench.input(), bench.computed);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace computed_torque_test

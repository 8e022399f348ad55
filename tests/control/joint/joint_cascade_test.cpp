#include <algorithm>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

namespace joint_cascade_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

ObjectBench tuned() {
  ObjectBench bench(make_joint_cascade);
  bench.set("hip.kp_per_s", 20);
  bench.set("hip.kv_Nms_per_rad", 4);
  bench.set("hip.ki_Nm_per_rad", 40);
  bench.start();
  bench.run(500);
  return bench;
}

}  // namespace

TEST_CASE("JointCascade follows a motion and its integral carries the load") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 0.8, 0.5);
  bench.run(2000);
  CHECK(bench.hip().position_rad == doctest::Approx(0.8).epsilon(1e-3));
  CHECK(bench.signal("hip.integral_Nm") == doctest::Approx(ObjectBench::load_Nm).epsilon(0.01));
}

TEST_CASE("JointCascade with the joint's inertia fed forward tracks better") {
  const auto worst_error_rad = [](double inertia_kg_m2) {
    ObjectBench bench = tuned();
    bench.set("hip.inertia_kg_m2", inertia_kg_m2);
    bench.run(2000);
    bench.set_point("hip.position_rad", 0.8, 0.4);
    double worst = 0;
    for (int i = 0; i < 400; ++i) {
      bench.tick();
      worst = std::max(worst, std::abs(bench.signal("hip.error_rad")));
    }
    return worst;
  };
  CHECK(worst_error_rad(ObjectBench::inertia_kg_m2) < 0.3 * worst_error_rad(0));
}

TEST_CASE("JointCascade on a long way asks for no more than velocity_max, and says so") {
  ObjectBench bench = tuned();
  bench.set("hip.velocity_max_rad_s", 1.5);
  bench.set_point("hip.position_rad", 1.9, 0);  // a jump
  double fastest = 0;
  bool limited = false;
  for (int i = 0; i < 800; ++i) {
    bench.tick();
    limited = limited || bench.signal("hip.velocity_limited") == 1;
    fastest = std::max(fastest, bench.hip().velocity_rad_s);
    REQUIRE(bench.signal("hip.velocity_command_rad_s") <= 1.5);
  }
  CHECK(limited);
  CHECK(fastest < 1.7);
  bench.run(3000);
  CHECK(bench.hip().position_rad == doctest::Approx(1.9).epsilon(1e-3));
  CHECK(bench.signal("hip.velocity_limited") == 0);
}

TEST_CASE("JointCascade limits the torque, says so, and a blocked joint winds nothing up") {
  ObjectBench bench = tuned();
  bench.set("hip.effort_max_Nm", 6);
  const JointState blocked{.position_rad = bench.hip().position_rad};
  bench.set_point("hip.position_rad", 1.0, 0);
  for (int i = 0; i < 3000; ++i) {
    bench.tick();
    bench.joints.joints[0] = blocked;
  }
  CHECK(bench.computed.joints[0].effort_Nm == 6);
  CHECK(bench.signal("hip.saturated") == 1);
  CHECK(std::abs(bench.signal("hip.integral_Nm")) <= 6);
  double farthest = 0;
  for (int i = 0; i < 3000; ++i) {
    bench.tick();
    farthest = std::max(farthest, bench.hip().position_rad);
  }
  CHECK(farthest < 1.1);
  CHECK(bench.hip().position_rad == doctest::Approx(1.0).epsilon(0.01));
}

}  // namespace joint_cascade_test

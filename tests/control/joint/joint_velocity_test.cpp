#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

using namespace kadans;
using kadans::test::ObjectBench;

TEST_CASE("JointVelocity ramps to its set-point in velocity mode, within the acceleration allowed") {
  ObjectBench bench(make_joint_velocity);
  bench.set("hip.acceleration_max_rad_s2", 4);
  bench.start();
  bench.compute();
  bench.set_point("hip.velocity_rad_s", 1.0, 0);
  bench.run(100);
  CHECK(bench.computed.joints[0].mode == ActuationMode::velocity);
  CHECK(bench.computed.joints[0].velocity_rad_s == doctest::Approx(0.4));
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.15));
  bench.run(300);
  CHECK(bench.computed.joints[0].velocity_rad_s == 1.0);
  bench.cancel("hip.velocity_rad_s");
  bench.run(300);
  CHECK(bench.computed.joints[0].velocity_rad_s == 0.0);
}

TEST_CASE("JointVelocity stops before the joint's limit and says so") {
  ObjectBench bench(make_joint_velocity);
  bench.set("hip.ki_Nm_per_rad", 100);
  bench.start();
  bench.set_point("hip.velocity_rad_s", 3.0, 0);
  double farthest = 0;
  for (int i = 0; i < 3000; ++i) {
    bench.tick();
    farthest = std::max(farthest, bench.hip().position_rad);
  }
  CHECK(farthest < 2.01);
  CHECK(farthest > 1.98);
  CHECK(bench.signal("hip.limited") == 1);
}

TEST_CASE("JointVelocity's integral carries a load under which the drive alone would creep") {
  const auto creep_rad_s = [](double ki_Nm_per_rad) {
    ObjectBench bench(make_joint_velocity);
    bench.set("hip.ki_Nm_per_rad", ki_Nm_per_rad);
    bench.start();
    bench.run(600);
    return bench.hip().velocity_rad_s;
  };
  CHECK(creep_rad_s(0) == doctest::Approx(-ObjectBench::load_Nm / ObjectBench::velocity_gain_Nms_per_rad));
  CHECK(std::abs(creep_rad_s(200)) < 1e-3);
}

TEST_CASE("JointVelocity bounds the torque that it adds, and says so") {
  ObjectBench bench(make_joint_velocity);
  bench.set("hip.ki_Nm_per_rad", 1000);
  bench.set("hip.effort_max_Nm", 1.5);
  bench.start();
  bench.run(2000);
  CHECK(bench.computed.joints[0].effort_Nm == 1.5);
  CHECK(bench.signal("hip.saturated") == 1);
}

#include <algorithm>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"
#include "kadans/signal/random.h"

using namespace kadans;
using kadans::test::ObjectBench;

TEST_CASE("JointIntegrator moves with the velocity asked for, in position mode with the velocity fed forward") {
  ObjectBench bench(make_joint_integrator);
  bench.start();
  bench.set_point("hip.velocity_rad_s", 0.5, 0);
  bench.run(1000);
  const JointActuation& asked = bench.computed.joints[0];
  CHECK(asked.mode == ActuationMode::position);
  CHECK(asked.velocity_rad_s == 0.5);
  // 25 ms to get there at 20 rad/s2; the tick of the start passes no time
  CHECK(asked.position_rad == doctest::Approx(0.5 * (0.999 - 0.0125)).epsilon(1e-3));
  CHECK(bench.hip().velocity_rad_s == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("JointIntegrator reaches a velocity in the time given, and says how long it takes") {
  ObjectBench bench(make_joint_integrator);
  bench.start();
  bench.compute();
  bench.set_point("hip.velocity_rad_s", 1.0, 0.5);
  bench.run(250);
  CHECK(bench.signal("hip.reference_velocity_rad_s") == doctest::Approx(0.5));
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.25));
  bench.run(250);
  CHECK(bench.signal("hip.reference_velocity_rad_s") == doctest::Approx(1.0));
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.0));
}

TEST_CASE("JointIntegrator brakes before the joint's limit, stops at it, says so, and turns back at once") {
  ObjectBench bench(make_joint_integrator);
  bench.set("hip.acceleration_max_rad_s2", 10);
  bench.start();
  bench.set_point("hip.velocity_rad_s", 4.0, 0);
  double before_rad_s = 0, hardest_rad_s2 = 0;
  for (int i = 0; i < 2000; ++i) {
    bench.tick();
    const JointActuation& asked = bench.computed.joints[0];
    REQUIRE(asked.position_rad <= 2.0);
    if (i > 0) hardest_rad_s2 = std::max(hardest_rad_s2, std::abs(asked.velocity_rad_s - before_rad_s) / 0.001);
    before_rad_s = asked.velocity_rad_s;
  }
  CHECK(hardest_rad_s2 <= 10 * (1 + 1e-9));
  CHECK(bench.computed.joints[0].position_rad == doctest::Approx(2.0).epsilon(1e-6));
  CHECK(bench.signal("hip.limited") == 1);
  CHECK(bench.motion_remaining_s() == 0);
  bench.set_point("hip.velocity_rad_s", -1.0, 0);
  bench.run(1);
  CHECK(bench.signal("hip.reference_velocity_rad_s") == doctest::Approx(-0.01));
  CHECK(bench.signal("hip.limited") == 0);
}

TEST_CASE("JointIntegrator never passes a limit or its acceleration, whatever is asked of it") {
  RandomStream random(5, "integrator");
  ObjectBench bench(make_joint_integrator);
  bench.set("hip.acceleration_max_rad_s2", 30);
  bench.start();
  bench.run(1);
  double before_rad_s = 0;
  for (int i = 0; i < 50000; ++i) {
    if (random.uniform() < 0.005) bench.set_point(0, random.uniform(-5, 5), random.uniform() < 0.5 ? 0 : 0.3);
    bench.tick();
    const JointActuation& asked = bench.computed.joints[0];
    REQUIRE(asked.position_rad >= -1.0 - 1e-12);
    REQUIRE(asked.position_rad <= 2.0 + 1e-12);
    REQUIRE(std::abs(asked.velocity_rad_s - before_rad_s) <= 0.03 * (1 + 1e-9));
    before_rad_s = asked.velocity_rad_s;
  }
}

TEST_CASE(
    "JointIntegrator taken over too fast to stop before a limit brakes as hard as it may and stays at the limit") {
  ObjectBench bench(make_joint_integrator);
  bench.joints.joints[0] = {.position_rad = 1.95, .velocity_rad_s = 3};
  bench.start();
  double before_rad_s = 3;
  for (int i = 0; i < 300; ++i) {
    bench.compute();
    const JointActuation& asked = bench.computed.joints[0];
    REQUIRE(asked.position_rad <= 2.0);
    REQUIRE(before_rad_s - asked.velocity_rad_s <= 0.02 * (1 + 1e-9));
    before_rad_s = asked.velocity_rad_s;
  }
  CHECK(bench.computed.joints[0].position_rad == 2.0);
  CHECK(before_rad_s == 0);
}

TEST_CASE("JointIntegrator does not run away from a blocked joint by more than lead_max") {
  ObjectBench bench(make_joint_integrator);
  bench.set("hip.lead_max_rad", 0.1);
  bench.start();
  bench.set_point("hip.velocity_rad_s", 1.0, 0);
  for (int i = 0; i < 3000; ++i) {
    bench.tick();
    bench.joints.joints[0] = {};
  }
  CHECK(bench.computed.joints[0].position_rad == doctest::Approx(0.1));
  CHECK(bench.signal("hip.limited") == 1);
}

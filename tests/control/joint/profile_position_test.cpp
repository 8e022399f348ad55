#include <algorithm>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

namespace profile_position_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

ObjectBench tuned() {
  ObjectBench bench(make_profile_position);
  bench.set("hip.velocity_max_rad_s", 2);
  bench.set("hip.acceleration_max_rad_s2", 10);
  bench.set("hip.jerk_max_rad_s3", 200);
  bench.start();
  bench.compute();
  return bench;
}

}  // namespace

TEST_CASE("ProfilePosition reaches a set-point as fast as its limits allow, in position mode") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 1.0, 0);
  CHECK(bench.motion_remaining_s() == doctest::Approx(1.0 / 2 + 2.0 / 10 + 10.0 / 200));
  double fastest = 0, hardest = 0;
  for (int i = 0; i < 760; ++i) {
    bench.tick();
    fastest = std::max(fastest, bench.computed.joints[0].velocity_rad_s);
    hardest = std::max(hardest, std::abs(bench.signal("hip.reference_acceleration_rad_s2")));
  }
  CHECK(bench.computed.joints[0].mode == ActuationMode::position);
  CHECK(bench.computed.joints[0].position_rad == 1.0);
  CHECK(fastest == doctest::Approx(2.0));
  CHECK(hardest == doctest::Approx(10.0));
  CHECK(bench.signal("hip.late") == 0);
}

TEST_CASE("ProfilePosition keeps the time given, or says that it is late") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 1.0, 2.0);
  bench.tick();
  CHECK(bench.motion_remaining_s() == doctest::Approx(1.999).epsilon(1e-3));
  CHECK(bench.signal("hip.late") == 0);
  bench.set_point("hip.position_rad", 1.0, 0.1);
  CHECK(bench.signal("hip.late") == 1);
  CHECK(bench.motion_remaining_s() > 0.5);
}

TEST_CASE("ProfilePosition takes a new set-point on the way without a step in velocity") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 1.0, 0);
  bench.run(300);
  double before = bench.computed.joints[0].velocity_rad_s, hardest = 0;
  bench.set_point("hip.position_rad", -0.5, 0);
  for (int i = 0; i < 2000; ++i) {
    bench.tick();
    hardest = std::max(hardest, std::abs(bench.computed.joints[0].velocity_rad_s - before) / 0.001);
    before = bench.computed.joints[0].velocity_rad_s;
  }
  CHECK(hardest <= 10.0 * (1 + 1e-6));
  CHECK(bench.computed.joints[0].position_rad == -0.5);
}

TEST_CASE("ProfilePosition cancelled stops soon, a joint too fast to stop before its limit is led back to it") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 1.0, 0);
  bench.run(300);
  bench.cancel("hip.position_rad");
  CHECK(bench.motion_remaining_s() < 0.3);

  bench.joints.joints[0] = {.position_rad = 1.95, .velocity_rad_s = 2};
  bench.written.joints[0] = {.mode = ActuationMode::off};
  bench.start();
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    bench.compute();
    farthest = std::max(farthest, bench.computed.joints[0].position_rad);
  }
  CHECK(farthest <= 2.0);
  CHECK(bench.computed.joints[0].position_rad == 2.0);
}

}  // namespace profile_position_test

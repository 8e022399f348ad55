#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

namespace feedforward_player_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

constexpr double two_pi = 2 * std::numbers::pi;

ObjectBench tuned() {
  ObjectBench bench(make_feedforward_player);
  bench.set("rate_Hz", 2);
  bench.set("hip.kp_Nm_per_rad", 100);
  bench.set("hip.kd_Nms_per_rad", 4);
  bench.written.joints[0] = {.effort_Nm = ObjectBench::load_Nm, .mode = ActuationMode::effort};
  bench.computed = bench.written;
  bench.start();
  return bench;
}

}  // namespace

TEST_CASE("FeedforwardPlayer plays its series of torques, harmonic by harmonic, beside the torque that was there") {
  ObjectBench bench = tuned();
  bench.set("hip.kp_Nm_per_rad", 0);
  bench.set("hip.kd_Nms_per_rad", 0);
  bench.set("hip.effort_cos1_Nm", 1);
  bench.set("hip.effort_sin2_Nm", 2);
  bench.set("hip.effort_cos3_Nm", 0.5);
  bench.set_point("hip.amplitude", 1, 0);
  for (int i = 0; i < 600; ++i) {
    bench.compute();
    const double phase = two_pi * 2 * 0.001 * i;
    const double series_Nm = std::cos(phase) + 2 * std::sin(2 * phase) + 0.5 * std::cos(3 * phase);
    REQUIRE(bench.computed.joints[0].effort_Nm == doctest::Approx(ObjectBench::load_Nm + series_Nm).epsilon(1e-9));
  }
}

TEST_CASE("FeedforwardPlayer's joint follows the motion, better when its torque is played too") {
  const auto worst_error_rad = [](double share) {
    ObjectBench bench = tuned();
    const double inertia_Nm = ObjectBench::inertia_kg_m2 * 0.3 * (two_pi * 2) * (two_pi * 2);
    bench.set("hip.position_sin1_rad", 0.3);
    bench.set("hip.effort_sin1_Nm", -share * inertia_Nm);
    bench.set_point("hip.amplitude", 1, 1.0);
    bench.run(2000);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
      bench.tick();
      worst = std::max(worst, std::abs(bench.signal("hip.error_rad")));
    }
    return worst;
  };
  CHECK(worst_error_rad(0) < 0.05);
  CHECK(worst_error_rad(1) < 0.3 * worst_error_rad(0));
}

TEST_CASE(
    "FeedforwardPlayer's reference velocity is the derivative of its reference, also while the amplitude changes") {
  ObjectBench bench = tuned();
  bench.set("hip.position_cos1_rad", 0.2);
  bench.set("hip.position_sin3_rad", 0.1);
  bench.set_point("hip.amplitude", 1, 0.4);
  bench.compute();
  double before = bench.signal("hip.reference_rad");
  double before_rad_s = bench.signal("hip.reference_velocity_rad_s");
  for (int i = 0; i < 800; ++i) {
    bench.compute();
    const double now = bench.signal("hip.reference_rad"), now_rad_s = bench.signal("hip.reference_velocity_rad_s");
    REQUIRE(std::abs((now - before) / 0.001 - 0.5 * (now_rad_s + before_rad_s)) < 0.01);
    before = now;
    before_rad_s = now_rad_s;
  }
}

TEST_CASE("FeedforwardPlayer limits reference and torque, and says so") {
  ObjectBench bench = tuned();
  bench.set("hip.position_sin1_rad", 3);
  bench.set("hip.effort_max_Nm", 5);
  bench.set_point("hip.amplitude", 1, 0);
  bool saturated = false;
  for (int i = 0; i < 500; ++i) {
    bench.compute();
    REQUIRE(bench.signal("hip.reference_rad") <= 2);
    REQUIRE(bench.signal("hip.reference_rad") >= -1);
    REQUIRE(std::abs(bench.computed.joints[0].effort_Nm) <= 5);
    saturated = saturated || bench.signal("hip.saturated") == 1;
  }
  CHECK(saturated);
}

TEST_CASE("FeedforwardPlayer cancelled fades out to its posture") {
  ObjectBench bench = tuned();
  bench.set("hip.position_cos1_rad", 0.2);
  bench.set_point("hip.amplitude", 1, 0);
  bench.run(300);
  bench.cancel("hip.amplitude");
  bench.run(101);
  CHECK(bench.signal("hip.amplitude") == 0);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.0));
}

}  // namespace feedforward_player_test

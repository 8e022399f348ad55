#include "kadans/testing/tracking.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "control/made_objects.h"
#include "kadans/testing/doctest.h"

namespace tracking_test {

using namespace kadans;
using namespace kadans::testing;

namespace {

constexpr double dt_s = 0.001;

}  // namespace

TEST_CASE("References are what they say: sine, chirp, there and back") {
  const std::vector<double> sine = sine_reference(0.5, 2, 1, dt_s, 0.1);
  CHECK(sine.size() == 1000);
  CHECK(sine[0] == 0.1);
  CHECK(sine[125] == doctest::Approx(0.6));
  const std::vector<double> chirp = chirp_reference(1, 1, 3, 2, dt_s);
  CHECK(chirp[500] == doctest::Approx(std::sin(2 * std::numbers::pi * 0.625)));  // 0.5 + 0.125 turns
  const std::vector<double> motion = there_and_back_reference(0.2, 1, 2, dt_s);
  CHECK(motion[0] == 0.2);
  CHECK(motion[500] == doctest::Approx(0.6));
  CHECK(motion[1000] == doctest::Approx(1));
  CHECK(motion[1999] == doctest::Approx(0.2).epsilon(1e-6));
}

TEST_CASE("A lag of first order tracks a slow sine with the error that its time constant says") {
  JointBench bench({.plant = {.inertia_kg_m2 = 0.002, .viscous_Nms_per_rad = 1}, .velocity_cutoff_Hz = 0},
                   make_joint_pid);
  bench.set("kp_Nm_per_rad", 20);  // time constant 0.05 s
  const Tracking tracking = track(bench, sine_reference(0.3, 0.5, 8, dt_s), 2);
  const double w_tau = 2 * std::numbers::pi * 0.5 * 0.05;
  const double peak = 0.3 * w_tau / std::sqrt(1 + w_tau * w_tau);
  INFO(tracking);
  CHECK(tracking.peak_error == doctest::Approx(peak).epsilon(0.03));
  CHECK(tracking.rms_error == doctest::Approx(peak / std::numbers::sqrt2).epsilon(0.03));
  CHECK(tracking.error.size() == 6000);
  CHECK(tracking <= TrackingLimits{.peak_error = 1.1 * peak});
  CHECK_FALSE(tracking <= TrackingLimits{.rms_error = 0.6 * peak});
}

}  // namespace tracking_test

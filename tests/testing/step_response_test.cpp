#include "kadans/testing/step_response.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <vector>

#include "control/made_objects.h"
#include "kadans/testing/doctest.h"

using namespace kadans;
using namespace kadans::testing;

namespace {

// x'' + 2 zeta w x' + w^2 x = w^2, from rest at 0.
double second_order(double t, double w, double zeta) {
  const double damped = w * std::sqrt(1 - zeta * zeta);
  return 1 - std::exp(-zeta * w * t) * (std::cos(damped * t) + zeta * w / damped * std::sin(damped * t));
}
double overshoot_percent(double zeta) { return 100 * std::exp(-std::numbers::pi * zeta / std::sqrt(1 - zeta * zeta)); }

std::vector<double> curve(double w, double zeta, double duration_s) {
  std::vector<double> values;
  for (int i = 0; i <= static_cast<int>(1000 * duration_s); ++i) values.push_back(second_order(0.001 * i, w, zeta));
  return values;
}

}  // namespace

TEST_CASE("Rise, overshoot, peak and settling of a second-order curve are what the formulas say") {
  const double w = 20, zeta = 0.4;
  const StepResponse r = measure_step(curve(w, zeta, 2), 0.001, 0, 1);
  CHECK(r.overshoot_percent == doctest::Approx(overshoot_percent(zeta)).epsilon(1e-4));
  CHECK(r.peak_time_s == doctest::Approx(std::numbers::pi / (w * std::sqrt(1 - zeta * zeta))).epsilon(0.01));
  // (1 + 1.1 zeta + 1.4 zeta^2) / w is the usual approximation of 10..90 % (Franklin, Powell, Emami-Naeini).
  CHECK(r.rise_time_s == doctest::Approx((1 + 1.1 * zeta + 1.4 * zeta * zeta) / w).epsilon(0.15));
  // The envelope passes 2 % at -ln(0.02 sqrt(1 - zeta^2)) / (zeta w); the curve settles within its last half swing.
  const double envelope_s = -std::log(0.02 * std::sqrt(1 - zeta * zeta)) / (zeta * w);
  CHECK(r.settling_time_s <= envelope_s);
  CHECK(r.settling_time_s >= envelope_s - std::numbers::pi / (w * std::sqrt(1 - zeta * zeta)));
  CHECK(std::abs(r.steady_state_error) < 1e-6);
}

TEST_CASE("A first-order curve rises in ln 9 time constants, settles after ln 50, and does not overshoot") {
  std::vector<double> values;
  for (int i = 0; i <= 2000; ++i)
    values.push_back(2 - 3 * (1 - std::exp(-0.001 * i / 0.1)));  // downwards, from 2 to -1
  const StepResponse r = measure_step(values, 0.001, 2, -1);
  CHECK(r.rise_time_s == doctest::Approx(0.1 * std::log(9.0)).epsilon(1e-3));
  CHECK(r.settling_time_s == doctest::Approx(0.1 * std::log(50.0)).epsilon(0.005));
  CHECK(r.overshoot_percent == doctest::Approx(0));
}

TEST_CASE("What was never reached is NaN and within no limit but none") {
  const std::vector<double> values(100, 0.05);
  const StepResponse r = measure_step(values, 0.001, 0, 1);
  CHECK(std::isnan(r.rise_time_s));
  CHECK(std::isnan(r.settling_time_s));
  CHECK(r.steady_state_error == doctest::Approx(0.95));
  CHECK(r <= StepLimits{});
  CHECK_FALSE(r <= StepLimits{.rise_time_s = 100});
  CHECK_FALSE(r <= StepLimits{.steady_state_error = 0.9});
  std::vector<double> sick(100, 1.0);
  sick[50] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(measure_step(sick, 0.001, 0, 1) <= StepLimits{.overshoot_percent = 1000});
  CHECK_THROWS_AS(measure_step(sick, 0.001, 1, 1), std::invalid_argument);
}

TEST_CASE("A PD on an inertia answers as its natural frequency and damping say") {
  const double w = 5, zeta = 0.3;
  JointBench bench({.plant = {.inertia_kg_m2 = 1}, .velocity_cutoff_Hz = 0}, make_joint_pid);
  bench.set("kp_Nm_per_rad", w * w);
  bench.set("kd_Nms_per_rad", 2 * zeta * w);
  const StepResponse r = step_response(bench, {.to = 0.2, .duration_s = 5});
  const StepResponse ideal = measure_step(curve(w, zeta, 5), 0.001, 0, 1);
  INFO(r);
  CHECK(r.overshoot_percent == doctest::Approx(overshoot_percent(zeta)).epsilon(0.02));
  CHECK(r.rise_time_s == doctest::Approx(ideal.rise_time_s).epsilon(0.02));
  CHECK(r.peak_time_s == doctest::Approx(ideal.peak_time_s).epsilon(0.02));
}

TEST_CASE("A constant load leaves a PD off by load / kp, and an integral takes it away") {
  JointBench bench({.plant = {.inertia_kg_m2 = 0.1, .load_Nm = -3}}, make_joint_pid);
  bench.set("kp_Nm_per_rad", 60);
  bench.set("kd_Nms_per_rad", 4);
  CHECK(step_response(bench, {.to = 0.3, .duration_s = 2}).steady_state_error == doctest::Approx(0.05));
  bench.set("ki_Nm_per_rads", 200);
  CHECK(step_response(bench, {.to = -0.3, .duration_s = 4}) <= StepLimits{.steady_state_error = 1e-3});
}

TEST_CASE("A response prints its numbers and a plot") {
  std::ostringstream out;
  out << measure_step(curve(20, 0.4, 1), 0.001, 0, 1);
  CHECK(out.str().find("overshoot 25.3") != std::string::npos);
  CHECK(out.str().find("⠉") != std::string::npos);
  CHECK(out.str().find(" 1 s\n") != std::string::npos);
}

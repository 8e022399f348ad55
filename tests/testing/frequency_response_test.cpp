#include "kadans/testing/frequency_response.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <sstream>

#include "control/made_objects.h"
#include "kadans/testing/doctest.h"

using namespace kadans;
using namespace kadans::testing;

namespace {

constexpr double dt_s = 0.001;
using Complex = std::complex<double>;

// TULip's lower leg, bare foot and rotor (0.0237 kg m2), held by a PD of kp 300; velocity through the estimator's
// filter.
std::unique_ptr<JointBench> leg_bench(double kp, double kd, std::uint32_t extra_ticks,
                                      VelocitySource source = VelocitySource::tachometer) {
  auto bench = std::make_unique<JointBench>(
      JointBenchConfig{.plant = {.inertia_kg_m2 = 0.0237, .delay_ticks = extra_ticks, .torque_max_Nm = 1e5},
                       .velocity_source = source},
      make_joint_pid);
  bench->set("kp_Nm_per_rad", kp);
  bench->set("kd_Nms_per_rad", kd);
  return bench;
}

// Whether a small step dies out.
bool stable(double kp, double kd, std::uint32_t extra_ticks, VelocitySource source) {
  const auto bench = leg_bench(kp, kd, extra_ticks, source);
  bench->set_point(0.001);
  bench->run(0.8);
  double largest = 0;
  for (int i = 0; i < 100; ++i) {
    bench->tick();
    largest = std::max(largest, std::abs(bench->position_rad() - 0.001));
  }
  return largest < 5e-4;
}

double largest_stable_kd(double kp, std::uint32_t extra_ticks, VelocitySource source) {
  double low = 3.5, high = 30;
  while (high - low > 0.02) {
    const double middle = 0.5 * (low + high);
    (stable(kp, middle, extra_ticks, source) ? low : high) = middle;
  }
  return low;
}

}  // namespace

TEST_CASE("The loop of a P controller on inertia and friction is kp / (s (J s + b)), late by a tick and a half") {
  JointBench bench({.plant = {.inertia_kg_m2 = 0.1, .viscous_Nms_per_rad = 2}, .velocity_cutoff_Hz = 0},
                   make_joint_pid);
  bench.set("kp_Nm_per_rad", 10);
  for (const FrequencyPoint& point : measure_loop(bench, {.low_Hz = 0.5, .high_Hz = 60, .points = 8, .settle_s = 3})) {
    const Complex s(0, 2 * std::numbers::pi * point.frequency_Hz);
    const Complex loop = 10.0 / (s * (0.1 * s + 2.0)) * std::exp(-1.5 * dt_s * s);
    INFO(point.frequency_Hz, " Hz");
    CHECK(point.gain == doctest::Approx(std::abs(loop)).epsilon(0.02));
    const double phase_deg = std::arg(loop) * 180 / std::numbers::pi;
    CHECK(std::abs(std::remainder(point.phase_deg - phase_deg, 360)) < 1.0);
  }
}

TEST_CASE("A closed loop of first order has -45 degrees and -3 dB at its bandwidth") {
  JointBench bench({.plant = {.inertia_kg_m2 = 0.001, .viscous_Nms_per_rad = 1}, .velocity_cutoff_Hz = 0},
                   make_joint_pid);
  bench.set("kp_Nm_per_rad", 2);
  const FrequencyResponse r = measure_reference(bench, {.low_Hz = 0.05, .high_Hz = 1.5, .points = 15, .settle_s = 4});
  INFO(r);
  const double corner_Hz = 2 / (2 * std::numbers::pi);
  CHECK(bandwidth_Hz(r) == doctest::Approx(corner_Hz).epsilon(0.05));
  for (const FrequencyPoint& point : r) {
    const double lag_deg = std::atan(point.frequency_Hz / corner_Hz) * 180 / std::numbers::pi;
    CHECK(std::abs(point.phase_deg + lag_deg) < 2.0);  // the tick's delay
  }
}

TEST_CASE("Margins are read where the gain passes 1 and the phase -180 degrees") {
  FrequencyResponse loop;  // an integrator of crossover 2 Hz with 25 ms of delay
  for (double f = 0.1; f < 40; f *= 1.05) loop.push_back({f, 2 / f, -90 - 360 * 0.025 * f});
  const LoopMargins m = margins(loop);
  CHECK(m.crossover_Hz == doctest::Approx(2).epsilon(1e-3));
  CHECK(m.phase_margin_deg == doctest::Approx(72).epsilon(1e-2));
  CHECK(m.delay_margin_s == doctest::Approx(0.1).epsilon(1e-2));
  CHECK(m.gain_margin == doctest::Approx(5).epsilon(1e-2));
  CHECK(std::isnan(margins({}).crossover_Hz));
  std::ostringstream out;
  out << m;
  CHECK(out.str().find("phase margin 7") != std::string::npos);
}

TEST_CASE("Delay takes the damping that a joint bears: kd up to 8.9, 6.5 and 4.8 Nms/rad at 1, 2 and 3 ticks") {
  const double known[] = {8.9, 6.5, 4.8};  // kp 300, inertia 0.0237, velocity through 100 Hz
  for (std::uint32_t ticks = 1; ticks <= 3; ++ticks) {
    CAPTURE(ticks);
    CHECK(largest_stable_kd(300, ticks - 1, VelocitySource::tachometer) ==
          doctest::Approx(known[ticks - 1]).epsilon(0.05));
    // The difference quotient of an encoder is half a tick later still.
    CHECK(largest_stable_kd(300, ticks - 1, VelocitySource::encoder) < 0.92 * known[ticks - 1]);
  }
}

TEST_CASE("The delay margin that the sweep finds is the delay at which the joint begins to swing") {
  const auto bench = leg_bench(100, 3.3, 0);
  const LoopMargins m = margins(measure_loop(*bench, {.low_Hz = 5, .high_Hz = 200, .points = 40, .settle_s = 0.3}));
  INFO(m);
  const double ticks = m.delay_margin_s / dt_s;
  REQUIRE(ticks > 1.2);
  REQUIRE(std::abs(ticks - std::round(ticks)) > 0.1);  // or the test would hang on a hair
  CHECK(stable(100, 3.3, static_cast<std::uint32_t>(std::floor(ticks)), VelocitySource::tachometer));
  CHECK_FALSE(stable(100, 3.3, static_cast<std::uint32_t>(std::ceil(ticks)), VelocitySource::tachometer));
}

TEST_CASE("A sweep of an unstable loop, and one without sense, are refused") {
  const auto bench = leg_bench(300, 12, 0);
  CHECK_THROWS_AS(measure_loop(*bench, {}), std::runtime_error);
  CHECK_THROWS_AS(measure_loop(*bench, {.high_Hz = 500}), std::invalid_argument);
  CHECK_THROWS_AS(measure_reference(*bench, {.low_Hz = 0}), std::invalid_argument);
}

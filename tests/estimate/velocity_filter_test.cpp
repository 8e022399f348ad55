#include "kadans/estimate/velocity_filter.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using kadans::RandomStream;
using kadans::VelocityFilter;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double dt_s = 0.001;

// The analogue Butterworth at its warped frequency, times the difference quotient: position to velocity.
std::complex<double> response(double frequency_Hz, double cutoff_Hz) {
  const std::complex<double> i(0, 1);
  const std::complex<double> s = i * std::tan(pi * frequency_Hz * dt_s) / std::tan(pi * cutoff_Hz * dt_s);
  const std::complex<double> quotient = (1.0 - std::exp(-i * 2.0 * pi * frequency_Hz * dt_s)) / dt_s;
  return quotient / (s * s + std::numbers::sqrt2 * s + 1.0);
}

// The filter's own gain and phase for a sine, by correlation over whole periods after it has settled.
std::complex<double> measured_response(VelocityFilter& filter, double frequency_Hz) {
  constexpr int settling = 2000, length = 10000;
  std::complex<double> sum = 0;
  for (int n = 0; n < settling + length; ++n) {
    const double phase = 2 * pi * frequency_Hz * n * dt_s;
    const double velocity = filter.update(std::sin(phase), dt_s);
    if (n >= settling) sum += velocity * std::polar(1.0, pi / 2 - phase);
  }
  return sum * 2.0 / static_cast<double>(length);
}

double rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// From white noise on the position (1 rad) to noise on the velocity, by Parseval.
double analytic_noise_gain(double cutoff_Hz) {
  constexpr int points = 20000;
  double sum = 0;
  for (int n = 0; n < points; ++n) sum += std::norm(response((n + 0.5) / points * 500, cutoff_Hz));
  return std::sqrt(sum / points);
}

}  // namespace

TEST_CASE("A chirp from 1 to 200 Hz comes out with the gain and the delay of the analytic filter") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  constexpr double sweep_Hz_per_s = 10, amplitude_rad = 0.1;
  double worst = 0;
  for (int n = 0; n < 19900; ++n) {
    const double t_s = n * dt_s;
    const double frequency_Hz = 1 + sweep_Hz_per_s * t_s;
    const double phase = 2 * pi * (t_s + sweep_Hz_per_s * t_s * t_s / 2);
    const double velocity = filter.update(amplitude_rad * std::sin(phase), dt_s);
    const std::complex<double> h = response(frequency_Hz, 100);
    const double expected = amplitude_rad * std::abs(h) * std::sin(phase + std::arg(h));
    if (n > 200) worst = std::max(worst, std::fabs(velocity - expected) / (amplitude_rad * std::abs(h)));
  }
  CHECK(worst < 0.01);
}

TEST_CASE("A motion that accelerates evenly is seen late by the filter's delay, and only that") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  double velocity_rad_s = 0, t_s = 0;
  for (int n = 0; n < 1000; ++n) {
    t_s = n * dt_s;
    velocity_rad_s = filter.update(t_s * t_s / 2, dt_s);  // velocity t
  }
  const double delay_s = t_s - velocity_rad_s;
  CHECK(delay_s == doctest::Approx(std::numbers::sqrt2 / (2 * pi * 100) + dt_s / 2).epsilon(0.04));
  CHECK(delay_s ==
        doctest::Approx(-std::arg(response(0.1, 100) * std::complex<double>(0, -1)) / (2 * pi * 0.1)).epsilon(0.001));
}

TEST_CASE("At the cut-off the gain is -3 dB of the difference quotient's") {
  for (const double cutoff_Hz : {10.0, 50.0, 100.0, 200.0, 400.0}) {
    CAPTURE(cutoff_Hz);
    VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
    CHECK(filter.set_cutoff(cutoff_Hz));
    const double quotient = 2 / dt_s * std::sin(pi * cutoff_Hz * dt_s);
    const double gain = std::abs(measured_response(filter, cutoff_Hz)) / quotient;
    CHECK(20 * std::log10(gain) == doctest::Approx(-3.0103).epsilon(0.001));
  }
}

TEST_CASE("White noise on the position comes through with the analytic noise gain") {
  for (const double cutoff_Hz : {30.0, 100.0}) {
    CAPTURE(cutoff_Hz);
    VelocityFilter filter({.cutoff_Hz = cutoff_Hz, .dt_s = dt_s});
    RandomStream noise(1, "velocity");
    std::vector<double> velocity;
    velocity.reserve(200000);
    for (int n = 0; n < 200000; ++n) velocity.push_back(filter.update(1e-4 * noise.normal(), dt_s));
    CHECK(rms(velocity) == doctest::Approx(1e-4 * analytic_noise_gain(cutoff_Hz)).epsilon(0.02));
  }
}

TEST_CASE("An encoder's steps come through as the noise of their size") {
  constexpr double resolution_rad = 2 * pi / 65536;
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s}), exact({.cutoff_Hz = 100, .dt_s = dt_s});
  std::vector<double> error, raw_error;
  for (int n = 0; n < 20000; ++n) {
    const double position_rad = 0.5 * std::sin(2 * pi * 0.7 * n * dt_s);
    const double encoder_rad = std::round(position_rad / resolution_rad) * resolution_rad;
    error.push_back(filter.update(encoder_rad, dt_s) - exact.update(position_rad, dt_s));
    raw_error.push_back(filter.state().quotient_rad_s - exact.state().quotient_rad_s);
  }
  const double step_noise_rad = resolution_rad / std::sqrt(12.0);
  CHECK(rms(error) == doctest::Approx(step_noise_rad * analytic_noise_gain(100)).epsilon(0.1));
  CHECK(rms(error) < 0.25 * rms(raw_error));
}

TEST_CASE("The first reading gives no velocity, wherever the joint is") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  CHECK(filter.update(1.7, dt_s) == 0);
  CHECK(filter.update(1.7, dt_s) == 0);
  filter.update(1.8, dt_s);
  CHECK(filter.state().velocity_rad_s > 0);
  filter.reset();
  CHECK(filter.update(-1.7, dt_s) == 0);
}

TEST_CASE("Late and missing readings do not disturb an even motion") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  RandomStream random(2, "timing");
  double t_s = 0, worst_rad_s = 0;
  for (int n = 0; n < 3000; ++n) {
    const double elapsed_s = dt_s * (random.uniform() < 0.1 ? random.uniform(1, 60) : random.uniform(0.9, 1.4));
    t_s += elapsed_s;
    const double velocity_rad_s = filter.update(2 * t_s, elapsed_s);
    if (t_s > 0.1) worst_rad_s = std::max(worst_rad_s, std::fabs(velocity_rad_s - 2));
  }
  CHECK(worst_rad_s < 1e-6);
}

TEST_CASE("With every third reading missing a swing is seen nearly as with all of them") {
  VelocityFilter all({.cutoff_Hz = 100, .dt_s = dt_s}), some({.cutoff_Hz = 100, .dt_s = dt_s});
  double elapsed_s = 0, worst_rad_s = 0;
  for (int n = 0; n < 3000; ++n) {
    const double position_rad = 0.3 * std::sin(2 * pi * 2 * n * dt_s);
    const double reference_rad_s = all.update(position_rad, dt_s);
    elapsed_s += dt_s;
    if (n % 3 == 1) continue;
    const double velocity_rad_s = some.update(position_rad, elapsed_s);
    elapsed_s = 0;
    if (n > 100) worst_rad_s = std::max(worst_rad_s, std::fabs(velocity_rad_s - reference_rad_s));
  }
  CHECK(worst_rad_s < 0.01 * 0.3 * 2 * pi * 2);
}

TEST_CASE("After a gap longer than its memory the filter starts from the mean velocity over the gap") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  for (int n = 0; n < 100; ++n) filter.update(-5 * n * dt_s, dt_s);
  const double before_rad = filter.state().position_rad;
  CHECK(filter.update(before_rad + 3, 1.5) == doctest::Approx(2));
  CHECK(filter.update(before_rad + 3.002, dt_s) == doctest::Approx(2));
}

TEST_CASE("A cut-off outside its range is refused and the old one stays") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  for (const double wrong_Hz : {0.0, -1.0, 450.0, 1e9, std::nan("")}) {
    CHECK_FALSE(filter.set_cutoff(wrong_Hz));
    CHECK_THROWS_AS(VelocityFilter({.cutoff_Hz = wrong_Hz, .dt_s = dt_s}), std::invalid_argument);
  }
  CHECK(filter.config().cutoff_Hz == 100);
  CHECK(filter.set_cutoff(449));
  CHECK_THROWS_WITH(VelocityFilter({.cutoff_Hz = 600, .dt_s = dt_s}),
                    "cutoff_Hz = 600.000000 is outside (0, 450.000000)");
  for (const double wrong_s : {0.0, -0.001, std::nan(""), std::numeric_limits<double>::infinity()})
    CHECK_THROWS_AS(VelocityFilter({.cutoff_Hz = 100, .dt_s = wrong_s}), std::invalid_argument);
}

TEST_CASE("A reading or a time that is not finite changes nothing") {
  VelocityFilter filter({.cutoff_Hz = 100, .dt_s = dt_s});
  for (int n = 0; n < 100; ++n) filter.update(2 * n * dt_s, dt_s);
  const double infinity = std::numeric_limits<double>::infinity();
  const VelocityFilter::State before = filter.state();
  filter.update(std::nan(""), dt_s);
  filter.update(infinity, dt_s);
  filter.update(1, std::nan(""));
  filter.update(1, 0);
  filter.update(1, -dt_s);
  CHECK(filter.state().position_rad == before.position_rad);
  CHECK(filter.state().velocity_rad_s == before.velocity_rad_s);
  CHECK(filter.update(2 * 100 * dt_s, dt_s) == doctest::Approx(2));
}

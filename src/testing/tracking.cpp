
#include "kadans/testing/tracking.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>

#include "kadans/control/minimum_jerk.h"
#include "kadans/testing/joint_bench.h"
#include "telemetry/plot.h"

namespace kadans::testing {
namespace {

template <typename Value>
std::vector<double> sampled(double duration_s, double dt_s, Value&& value) {
  std::vector<double> values;
  const auto ticks = std::llround(duration_s / dt_s);
  for (long long i = 0; i < ticks; ++i) values.push_back(value(dt_s * static_cast<double>(i)));
  return values;
}

}  // namespace

std::vector<double> sine_reference(double amplitude, double frequency_Hz, double duration_s, double dt_s,
                                   double offset) {
  return chirp_reference(amplitude, frequency_Hz, frequency_Hz, duration_s, dt_s, offset);
}

std::vector<double> chirp_reference(double amplitude, double low_Hz, double high_Hz, double duration_s, double dt_s,
                                    double offset) {
  return sampled(duration_s, dt_s, [=](double t) {
    const double turns = t * (low_Hz + 0.5 * (high_Hz - low_Hz) * t / duration_s);
    return offset + amplitude * std::sin(2 * std::numbers::pi * turns);
  });
}

std::vector<double> there_and_back_reference(double from, double to, double duration_s, double dt_s) {
  MinimumJerk motion;
  motion.reset(from);
  motion.move(to, 0.5 * duration_s);
  return sampled(duration_s, dt_s, [&](double) {
    const double now = motion.state().value;
    motion.step(dt_s);
    if (motion.remaining_s() == 0 && motion.target() == to) motion.move(from, 0.5 * duration_s);
    return now;
  });
}

Tracking track(JointBench& bench, std::span<const double> reference, double skip_s) {
  Tracking tracking{.dt_s = bench.config().dt_s};
  const auto skipped = static_cast<std::size_t>(std::llround(std::max(0.0, skip_s) / tracking.dt_s));
  double sum = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double error = reference[i] - bench.position_rad();
    bench.set_point(reference[i]);
    bench.tick();
    if (i < skipped) continue;
    tracking.error.push_back(error);
    sum += error * error;
    if (!(std::abs(error) <= tracking.peak_error)) tracking.peak_error = std::abs(error);
  }
  if (!tracking.error.empty()) tracking.rms_error = std::sqrt(sum / static_cast<double>(tracking.error.size()));
  return tracking;
}

bool operator<=(const Tracking& tracking, const TrackingLimits& limits) noexcept {
  return tracking.rms_error <= limits.rms_error && tracking.peak_error <= limits.peak_error;
}

std::ostream& operator<<(std::ostream& out, const Tracking& tracking) {
  out << "tracking error: RMS " << tracking.rms_error << " rad, peak " << tracking.peak_error << " rad\n";
  const double duration_s = tracking.dt_s * static_cast<double>(tracking.error.size());
  return out << curve_text("", tracking.error, 0, duration_s, {.rows = 6});
}

std::ostream& operator<<(std::ostream& out, const TrackingLimits& limits) {
  return out << "RMS <= " << limits.rms_error << " rad, peak <= " << limits.peak_error << " rad";
}

}  // namespace kadans::testing

#include "kadans/testing/tracking.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "kadans/testing/joint_bench.h"
#include "telemetry/plot.h"

namespace kadans::testing {

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

// How well a joint follows a reference that is given as a set-point each tick.
//
//   const Tracking tracking = track(bench, sine_reference(0.3, 0.5, 4, bench.config().dt_s));
//   CHECK(tracking <= TrackingLimits{.rms_error = 0.01, .peak_error = 0.02});
#pragma once

#include <iosfwd>
#include <limits>
#include <span>
#include <vector>

namespace kadans::testing {

class JointBench;

struct Tracking {
  double dt_s = 0;
  std::vector<double> error;  // rad: the reference of a tick minus the position at its beginning
  double rms_error = 0, peak_error = 0;
};

struct TrackingLimits {
  double rms_error = std::numeric_limits<double>::infinity();
  double peak_error = std::numeric_limits<double>::infinity();
};

// The first skip_s are run but not judged.
Tracking track(JointBench& bench, std::span<const double> reference, double skip_s = 0);

bool operator<=(const Tracking& tracking, const TrackingLimits& limits) noexcept;
std::ostream& operator<<(std::ostream& out, const Tracking& tracking);
std::ostream& operator<<(std::ostream& out, const TrackingLimits& limits);

}  // namespace kadans::testing

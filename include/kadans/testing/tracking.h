// References to track, and how well a joint follows one that is given as a set-point each tick.
#pragma once

#include <iosfwd>
#include <limits>
#include <span>
#include <vector>

namespace kadans::testing {

// References to track: one value per tick.

// offset + amplitude sin(2 pi f t); at t = 0 it is at the offset and moves.
std::vector<double> sine_reference(double amplitude, double frequency_Hz, double duration_s, double dt_s,
                                   double offset = 0);
// A sine whose frequency grows evenly from low_Hz to high_Hz.
std::vector<double> chirp_reference(double amplitude, double low_Hz, double high_Hz, double duration_s, double dt_s,
                                    double offset = 0);
// From one value to the other and back, at rest at both ends (minimum jerk), in duration_s.
std::vector<double> there_and_back_reference(double from, double to, double duration_s, double dt_s);

// How well a joint follows a reference that is given as a set-point each tick.
//
//   const Tracking tracking = track(bench, sine_reference(0.3, 0.5, 4, bench.config().dt_s));
//   CHECK(tracking <= TrackingLimits{.rms_error = 0.01, .peak_error = 0.02});
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

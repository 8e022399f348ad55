// Gain and phase over frequency, measured on the bench with one sine after another (a chirp that waits at each
// frequency until the answer is steady, so that the numbers are exact and not smeared).
//
// measure_loop adds a torque at the joint and measures how much of it the control object takes back. This is the loop,
// opened at the drive, with all delays, whatever the law inside. It gives the margins.
//
//   const FrequencyResponse loop = measure_loop(bench, {});
//   CHECK(margins(loop).phase_margin_deg > 40);
//
// measure_reference moves the set-point and measures how the joint follows: the closed loop, with its bandwidth. Each
// frequency is the one nearest to the wanted one of which a whole number of periods fits into whole ticks.
#pragma once

#include <iosfwd>
#include <vector>

namespace kadans::testing {

class JointBench;

struct SweepOptions {
  double low_Hz = 0.5, high_Hz = 100;  // high: well below half of the tick's frequency
  int points = 25;                     // evenly on the logarithmic axis
  double amplitude = 0.05;             // Nm of measure_loop, rad of measure_reference
  double settle_s = 0.5;               // before measuring at each frequency
  int periods = 5;                     // measured
};

struct FrequencyPoint {
  double frequency_Hz = 0;
  double gain = 0;
  double phase_deg = 0;  // continuous over the points; the first in (-360, 0]
};

using FrequencyResponse = std::vector<FrequencyPoint>;

// What is not within the measured frequencies is NaN.
struct LoopMargins {
  double crossover_Hz = 0;      // where the gain falls below 1, last
  double phase_margin_deg = 0;  // there
  double delay_margin_s = 0;    // how much more delay the loop can have before it is unstable
  double gain_margin = 0;       // factor on the loop, where the phase is -180 degrees, beyond the crossover
};

// Both throw std::invalid_argument on options that make no sense and std::runtime_error when the joint does not stay
// within its limits: the loop is unstable or the amplitude too large.
FrequencyResponse measure_loop(JointBench& bench, const SweepOptions& options);
FrequencyResponse measure_reference(JointBench& bench, const SweepOptions& options);

LoopMargins margins(const FrequencyResponse& loop);
// Where the gain falls 3 dB below that of the lowest frequency; NaN when it does not.
double bandwidth_Hz(const FrequencyResponse& reference);

std::ostream& operator<<(std::ostream& out, const FrequencyResponse& response);
std::ostream& operator<<(std::ostream& out, const LoopMargins& margins);

}  // namespace kadans::testing

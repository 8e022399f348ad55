// How a joint responds to a step of its set-point, in the usual numbers.
//
//   const StepResponse response = step_response(bench, {.to = 0.2});
//   CHECK(response <= StepLimits{.rise_time_s = 0.1, .overshoot_percent = 5});
//
// A check that fails prints the response as numbers and as a small plot. Numbers that the response never reached are
// NaN; NaN is within no limit.
#pragma once

#include <iosfwd>
#include <limits>
#include <span>
#include <vector>

namespace kadans::testing {

class JointBench;

struct StepOptions {
  double to = 0.1;          // set-point, from where the joint is
  double duration_s = 1.0;  // recorded
};

struct StepResponse {
  double from = 0, to = 0;  // rad
  double dt_s = 0;
  std::vector<double> values;     // position per tick; the first one before the step
  double rise_time_s = 0;         // from 10 % to 90 % of the way
  double overshoot_percent = 0;   // of the way; 0 when it does not pass the goal
  double peak_time_s = 0;         // of the largest value on the way
  double settling_time_s = 0;     // after which it stays within 2 % of the way around the goal
  double steady_state_error = 0;  // goal minus the mean of the last tenth, rad
};

struct StepLimits {
  double rise_time_s = std::numeric_limits<double>::infinity();
  double overshoot_percent = std::numeric_limits<double>::infinity();
  double settling_time_s = std::numeric_limits<double>::infinity();
  double steady_state_error = std::numeric_limits<double>::infinity();  // either way
};

StepResponse step_response(JointBench& bench, const StepOptions& options);
// The same for a recorded signal: values[0] is the one before the step. Throws std::invalid_argument without a step or
// values.
StepResponse measure_step(std::span<const double> values, double dt_s, double from, double to);

// Whether every number keeps within its limit.
bool operator<=(const StepResponse& response, const StepLimits& limits) noexcept;
std::ostream& operator<<(std::ostream& out, const StepResponse& response);
std::ostream& operator<<(std::ostream& out, const StepLimits& limits);

}  // namespace kadans::testing

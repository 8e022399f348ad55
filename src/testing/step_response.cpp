#include "kadans/testing/step_response.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "kadans/testing/joint_bench.h"
#include "telemetry/plot.h"

namespace kadans::testing {
namespace {

constexpr double not_reached = std::numeric_limits<double>::quiet_NaN();
constexpr double settled_share = 0.02;

// When the share of the way first reaches `level`, between ticks by a straight line.
double crossing_s(const StepResponse& r, double level) {
  const double threshold = r.from + level * (r.to - r.from);
  const double direction = r.to > r.from ? 1 : -1;
  for (std::size_t i = 1; i < r.values.size(); ++i) {
    const double before = direction * (r.values[i - 1] - threshold), after = direction * (r.values[i] - threshold);
    if (after >= 0) return r.dt_s * (static_cast<double>(i) - (after > before ? after / (after - before) : 0));
  }
  return not_reached;
}

double settling_s(const StepResponse& r) {
  const double band = settled_share * std::abs(r.to - r.from);
  std::size_t settled = r.values.size();
  while (settled > 0 && std::abs(r.values[settled - 1] - r.to) <= band) --settled;
  return settled == r.values.size() ? not_reached : r.dt_s * static_cast<double>(settled);
}

double mean_of_last_tenth(std::span<const double> values) {
  const std::size_t count = std::max<std::size_t>(1, values.size() / 10);
  double sum = 0;
  for (const double value : values.last(count)) sum += value;
  return sum / static_cast<double>(count);
}

}  // namespace

StepResponse measure_step(std::span<const double> values, double dt_s, double from, double to) {
  if (values.empty() || !(dt_s > 0) || !std::isfinite(to - from) || to == from) {
    throw std::invalid_argument("a step response needs values, a period and a step");
  }
  StepResponse r{.from = from, .to = to, .dt_s = dt_s, .values = {values.begin(), values.end()}};
  r.rise_time_s = crossing_s(r, 0.9) - crossing_s(r, 0.1);
  const auto passed = [&](double value) { return (value - to) / (to - from); };
  const auto peak = std::ranges::max_element(r.values, {}, passed);
  r.peak_time_s = dt_s * static_cast<double>(peak - r.values.begin());
  const bool finite = std::ranges::all_of(r.values, [](double value) { return std::isfinite(value); });
  r.overshoot_percent = finite ? 100 * std::max(0.0, passed(*peak)) : not_reached;
  r.settling_time_s = settling_s(r);
  r.steady_state_error = to - mean_of_last_tenth(r.values);
  return r;
}

StepResponse step_response(JointBench& bench, const StepOptions& options) {
  bench.tick();
  const double from = bench.position_rad();
  std::vector<double> values{from};
  bench.set_point(options.to);
  const auto ticks = std::llround(options.duration_s / bench.config().dt_s);
  for (long long i = 0; i < ticks; ++i) {
    bench.tick();
    values.push_back(bench.position_rad());
  }
  return measure_step(values, bench.config().dt_s, from, options.to);
}

bool operator<=(const StepResponse& response, const StepLimits& limits) noexcept {
  const auto within = [](double value, double limit) {
    return limit == std::numeric_limits<double>::infinity() || value <= limit;
  };
  return within(response.rise_time_s, limits.rise_time_s) &&
         within(response.overshoot_percent, limits.overshoot_percent) &&
         within(response.settling_time_s, limits.settling_time_s) &&
         within(std::abs(response.steady_state_error), limits.steady_state_error);
}

std::ostream& operator<<(std::ostream& out, const StepResponse& r) {
  out << "step " << r.from << " -> " << r.to << ": rise " << r.rise_time_s << " s, overshoot " << r.overshoot_percent
      << " %, settled after " << r.settling_time_s << " s, steady-state error " << r.steady_state_error << '\n';
  return out << curve_text("", r.values, 0, r.dt_s * static_cast<double>(r.values.size() - 1), {.rows = 6});
}

std::ostream& operator<<(std::ostream& out, const StepLimits& limits) {
  return out << "rise <= " << limits.rise_time_s << " s, overshoot <= " << limits.overshoot_percent
             << " %, settled <= " << limits.settling_time_s
             << " s, steady-state error <= " << limits.steady_state_error;
}

}  // namespace kadans::testing

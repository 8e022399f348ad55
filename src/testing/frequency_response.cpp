#include "kadans/testing/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <ostream>
#include <stdexcept>

#include "kadans/testing/joint_bench.h"

namespace kadans::testing {
namespace {

using Complex = std::complex<double>;
constexpr double never = std::numeric_limits<double>::quiet_NaN();

void check(const JointBench& bench, const SweepOptions& options) {
  const double nyquist_Hz = 0.5 / bench.config().dt_s;
  const bool sane = options.low_Hz > 0 && options.high_Hz > options.low_Hz && options.high_Hz < nyquist_Hz &&
                    options.points >= 2 && options.amplitude > 0 && options.settle_s >= 0 && options.periods >= 1;
  if (!sane) {
    throw std::invalid_argument("a sweep needs 0 < low_Hz < high_Hz < " + std::to_string(nyquist_Hz) +
                                ", points >= 2, amplitude > 0, settle_s >= 0, periods >= 1");
  }
}

struct Sine {
  double frequency_Hz;
  long long settle_ticks, measured_ticks;
};

Sine sine_at(double wanted_Hz, const SweepOptions& options, double dt_s) {
  const long long ticks =
      std::max<long long>(2LL * options.periods, std::llround(options.periods / (wanted_Hz * dt_s)));
  const long long settle = std::llround(std::ceil(options.settle_s / dt_s));
  return {static_cast<double>(options.periods) / (static_cast<double>(ticks) * dt_s), settle, ticks};
}

// Runs the sine; `tick(value)` gives the pair (cause, effect), whose ratio effect / cause is the answer.
template <typename Tick>
Complex run(JointBench& bench, const Sine& sine, double amplitude, Tick&& tick) {
  const double rate = 2 * std::numbers::pi * sine.frequency_Hz * bench.config().dt_s;
  Complex cause = 0, effect = 0;
  for (long long i = -sine.settle_ticks; i < sine.measured_ticks; ++i) {
    const double angle = rate * static_cast<double>(i);
    const auto [in, out] = tick(amplitude * std::sin(angle));
    if (!(bench.position_rad() >= bench.config().lower_rad && bench.position_rad() <= bench.config().upper_rad)) {
      throw std::runtime_error("the joint leaves its range at " + std::to_string(sine.frequency_Hz) +
                               " Hz: the loop is unstable or the amplitude too large");
    }
    if (i < 0) continue;
    const Complex turned = std::polar(1.0, -angle);
    cause += in * turned;
    effect += out * turned;
  }
  return effect / cause;
}

template <typename Tick>
FrequencyResponse sweep(JointBench& bench, const SweepOptions& options, Tick&& tick) {
  check(bench, options);
  FrequencyResponse response;
  for (int i = 0; i < options.points; ++i) {
    const double share = static_cast<double>(i) / (options.points - 1);
    const double wanted_Hz = options.low_Hz * std::pow(options.high_Hz / options.low_Hz, share);
    const Sine sine = sine_at(wanted_Hz, options, bench.config().dt_s);
    const Complex ratio = run(bench, sine, options.amplitude, tick);
    double phase_deg = std::arg(ratio) * 180 / std::numbers::pi;
    const double near_deg = response.empty() ? -180 : response.back().phase_deg;
    phase_deg += 360 * std::round((near_deg - phase_deg) / 360);
    response.push_back({sine.frequency_Hz, std::hypot(ratio.real(), ratio.imag()), phase_deg});
  }
  return response;
}

// Between two points on logarithmic axes: where a quantity that is a at the first and b at the second is 0.
double log_between(double first, double second, double a, double b) {
  const double share = a == b ? 0 : a / (a - b);
  return std::exp(std::log(first) + share * (std::log(second) - std::log(first)));
}

}  // namespace

FrequencyResponse measure_loop(JointBench& bench, const SweepOptions& options) {
  return sweep(bench, options, [&bench](double push_Nm) {
    bench.plant().push(push_Nm);
    bench.tick();
    return std::pair(bench.torque_Nm() + push_Nm, -bench.torque_Nm());
  });
}

FrequencyResponse measure_reference(JointBench& bench, const SweepOptions& options) {
  if (bench.time_s() == 0) bench.tick();
  const double centre = bench.position_rad();
  return sweep(bench, options, [&bench, centre](double reference) {
    const double position_rad = bench.position_rad() - centre;
    bench.set_point(centre + reference);
    bench.tick();
    return std::pair(reference, position_rad);
  });
}

LoopMargins margins(const FrequencyResponse& loop) {
  LoopMargins found{never, never, never, never};
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const FrequencyPoint &a = loop[i - 1], &b = loop[i];
    if (!(a.gain >= 1 && b.gain < 1)) continue;
    found.crossover_Hz = log_between(a.frequency_Hz, b.frequency_Hz, std::log(a.gain), std::log(b.gain));
    const double share = std::log(a.gain) / (std::log(a.gain) - std::log(b.gain));
    found.phase_margin_deg = 180 + a.phase_deg + share * (b.phase_deg - a.phase_deg);
    found.delay_margin_s = found.phase_margin_deg / 360 / found.crossover_Hz;
  }
  for (std::size_t i = 1; i < loop.size(); ++i) {
    const FrequencyPoint &a = loop[i - 1], &b = loop[i];
    if (!(a.phase_deg > -180 && b.phase_deg <= -180) || !(b.frequency_Hz > found.crossover_Hz)) continue;
    const double share = (a.phase_deg + 180) / (a.phase_deg - b.phase_deg);
    found.gain_margin = 1 / std::exp(std::log(a.gain) + share * (std::log(b.gain) - std::log(a.gain)));
    break;
  }
  return found;
}

double bandwidth_Hz(const FrequencyResponse& reference) {
  if (reference.empty()) return never;
  const double threshold = reference[0].gain / std::numbers::sqrt2;
  for (std::size_t i = 1; i < reference.size(); ++i) {
    const FrequencyPoint &a = reference[i - 1], &b = reference[i];
    if (!(b.gain < threshold)) continue;
    return log_between(a.frequency_Hz, b.frequency_Hz, std::log(a.gain / threshold), std::log(b.gain / threshold));
  }
  return never;
}

std::ostream& operator<<(std::ostream& out, const FrequencyResponse& response) {
  out << "frequency response:\n        Hz       gain      phase, deg\n";
  for (const FrequencyPoint& point : response) {
    out << "  " << point.frequency_Hz << "  " << point.gain << "  " << point.phase_deg << '\n';
  }
  return out;
}

std::ostream& operator<<(std::ostream& out, const LoopMargins& found) {
  return out << "crossover " << found.crossover_Hz << " Hz, phase margin " << found.phase_margin_deg
             << " degrees, delay margin " << 1e3 * found.delay_margin_s << " ms, gain margin " << found.gain_margin;
}

}  // namespace kadans::testing

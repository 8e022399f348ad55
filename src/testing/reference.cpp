#include "kadans/testing/reference.h"

#include <cmath>
#include <numbers>

#include "kadans/control/minimum_jerk.h"

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
    const double now = motion.state().position;
    motion.step(dt_s);
    if (motion.remaining_s() == 0 && motion.target() == to) motion.move(from, 0.5 * duration_s);
    return now;
  });
}

}  // namespace kadans::testing

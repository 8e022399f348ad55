#include "kadans/estimate/velocity_filter.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "signal/sine_cosine.h"

namespace kadans {
namespace {

constexpr double cutoff_max_in_rates = 0.45;  // of the sampling rate; the warping grows without bound at 0.5
constexpr double steps_max = 32;              // a longer gap is crossed in longer steps
constexpr double jitter_max = 0.05;           // of the period

bool is_cutoff(double cutoff_Hz, double dt_s) noexcept {
  return cutoff_Hz > 0 && cutoff_Hz * dt_s < cutoff_max_in_rates;
}

}  // namespace

VelocityFilter::VelocityFilter(const Config& config) : config_(config) {
  if (!(config.dt_s > 0 && std::isfinite(config.dt_s)))
    throw std::invalid_argument("dt_s = " + std::to_string(config.dt_s) + " must be > 0");
  if (!is_cutoff(config.cutoff_Hz, config.dt_s))
    throw std::invalid_argument("cutoff_Hz = " + std::to_string(config.cutoff_Hz) + " is outside (0, " +
                                std::to_string(cutoff_max_in_rates / config.dt_s) + ")");
  prewarp();
}

double VelocityFilter::delay_s(const Config& config) noexcept {
  return std::numbers::sqrt2 / (2 * std::numbers::pi * config.cutoff_Hz) + 0.5 * config.dt_s;
}

bool VelocityFilter::set_cutoff(double cutoff_Hz) noexcept {
  if (!is_cutoff(cutoff_Hz, config_.dt_s)) return false;
  config_.cutoff_Hz = cutoff_Hz;
  prewarp();
  return true;
}

void VelocityFilter::prewarp() noexcept {
  const double slope_per_s = std::numbers::pi * config_.cutoff_Hz;
  nominal_gain_ = std::tan(slope_per_s * config_.dt_s);
  gain_slope_per_s_ = slope_per_s * (1 + nominal_gain_ * nominal_gain_);
  set_step(config_.dt_s);
}

void VelocityFilter::set_step(double step_s) noexcept {
  step_s_ = step_s;
  const double late_s = step_s - config_.dt_s;
  double g = nominal_gain_ + gain_slope_per_s_ * late_s;  // along the tangent: enough in most ticks
  if (std::fabs(late_s) > jitter_max * config_.dt_s) {
    const auto [sine, cosine] = sine_cosine(std::numbers::pi * config_.cutoff_Hz * step_s);
    g = sine / cosine;
  }
  a1_ = 1 / (1 + g * (g + std::numbers::sqrt2));  // damping sqrt(2) / 2: Butterworth
  a2_ = g * a1_;
  a3_ = g * a2_;
}

void VelocityFilter::reset() noexcept {
  state_ = {};
  band_rad_s_ = low_rad_s_ = 0;
  started_ = false;
}

void VelocityFilter::update_unevenly(double position_rad, double elapsed_s) noexcept {
  if (!std::isfinite(position_rad)) return;
  if (!started_) {
    started_ = true;
    state_.position_rad = position_rad;
    return;
  }
  if (!(elapsed_s > 0 && std::isfinite(elapsed_s))) return;
  take(position_rad, elapsed_s);

  double steps = 1;
  if (elapsed_s != config_.dt_s) {
    steps = std::clamp(std::round(elapsed_s / config_.dt_s), 1.0, steps_max);
    if (!is_cutoff(config_.cutoff_Hz, elapsed_s / steps)) steps += 1;
  }
  const double step_s = elapsed_s / steps;
  if (!is_cutoff(config_.cutoff_Hz, step_s)) {  // so long that the filter has forgotten everything before
    band_rad_s_ = 0;
    low_rad_s_ = state_.velocity_rad_s = state_.quotient_rad_s;
    return;
  }
  if (step_s != step_s_) set_step(step_s);
  for (int step = 0; step < static_cast<int>(steps); ++step) pass();
}

}  // namespace kadans

#include "orientation_filter.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

constexpr double gravity_m_s2 = 9.81;

void require(bool ok, const char* field, double value, const char* range) {
  if (!ok) throw std::invalid_argument(std::string(field) + " = " + std::to_string(value) + " must be " + range);
}

// The rotation by rate * time: cosine and sine of the half angle, as series where they are exact in double precision.
Quat turn(const Vec3& rate_rad_s, double time_s) noexcept {
  const double x = rate_rad_s[0] * time_s / 2, y = rate_rad_s[1] * time_s / 2, z = rate_rad_s[2] * time_s / 2;
  const double h2 = x * x + y * y + z * z;  // half angle squared
  double cosine, sine_by_h;
  if (h2 < 1e-3) {
    cosine = 1 - h2 / 2 * (1 - h2 / 12 * (1 - h2 / 30));
    sine_by_h = 1 - h2 / 6 * (1 - h2 / 20 * (1 - h2 / 42));
  } else {
    const double h = std::sqrt(h2);
    cosine = std::cos(h);
    sine_by_h = std::sin(h) / h;
  }
  return {cosine, sine_by_h * x, sine_by_h * y, sine_by_h * z};
}

}  // namespace

OrientationFilter::OrientationFilter(const Config& config) : config_(config) {
  const auto not_negative = [](double value) { return value >= 0 && std::isfinite(value); };
  require(not_negative(config.accelerometer_gain_per_s), "accelerometer_gain_per_s", config.accelerometer_gain_per_s,
          ">= 0");
  require(not_negative(config.gyro_bias_gain_per_s2), "gyro_bias_gain_per_s2", config.gyro_bias_gain_per_s2, ">= 0");
  require(config.gravity_tolerance > 0, "gravity_tolerance", config.gravity_tolerance, "> 0");
  require(config.gyro_bias_max_rad_s >= 0, "gyro_bias_max_rad_s", config.gyro_bias_max_rad_s, ">= 0");
}

void OrientationFilter::update(const Vec3& gyro_rad_s, const Vec3& specific_force_m_s2, double elapsed_s) noexcept {
  if (!is_finite(gyro_rad_s) || !(elapsed_s > 0 && std::isfinite(elapsed_s))) return;
  const Vec3& f = specific_force_m_s2;
  const double norm_m_s2 = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);  // NaN and infinity fail what follows
  if (!state_.initialised) {
    last_gyro_rad_s_ = state_.angular_velocity_rad_s = gyro_rad_s;
    if (norm_m_s2 > 0.5 * gravity_m_s2 && norm_m_s2 < 1.5 * gravity_m_s2) initialise(f);
    return;
  }
  Vec3 mean_rad_s;
  for (std::size_t i = 0; i < 3; ++i)  // of both ends of the step: what is left is of third order in the step
    mean_rad_s[i] = (gyro_rad_s[i] + last_gyro_rad_s_[i]) / 2 - state_.gyro_bias_rad_s[i];
  last_gyro_rad_s_ = gyro_rad_s;
  state_.orientation = multiply(state_.orientation, turn(mean_rad_s, elapsed_s));
  correct(f, norm_m_s2, elapsed_s);
  state_.orientation = normalized(state_.orientation);
  for (std::size_t i = 0; i < 3; ++i) state_.angular_velocity_rad_s[i] = gyro_rad_s[i] - state_.gyro_bias_rad_s[i];
}

Quat OrientationFilter::orientation_after(double time_s) const noexcept {
  return normalized(multiply(state_.orientation, turn(state_.angular_velocity_rad_s, time_s)));
}

// The shortest rotation that brings the measured up onto the world's z, without yaw.
void OrientationFilter::initialise(const Vec3& specific_force_m_s2) noexcept {
  const Vec3& f = specific_force_m_s2;
  const double roll_rad = std::atan2(f[1], f[2]);
  const double pitch_rad = std::atan2(-f[0], std::sqrt(f[1] * f[1] + f[2] * f[2]));
  state_.orientation = from_roll_pitch_yaw(roll_rad, pitch_rad, 0);
  state_.gravity_weight = 1;
  state_.initialised = true;
}

// The error is measured up x estimated up, weighted, both now and in the base frame: the axis to turn about, times the
// sine of the angle.
void OrientationFilter::correct(const Vec3& specific_force_m_s2, double norm_m_s2, double elapsed_s) noexcept {
  const double deviation = std::fabs(norm_m_s2 / gravity_m_s2 - 1);
  const bool trusted = deviation < config_.gravity_tolerance && norm_m_s2 > 0;
  state_.gravity_weight = trusted ? 1 - deviation / config_.gravity_tolerance : 0;
  if (!trusted) return;
  const Vec3& f = specific_force_m_s2;
  const Vec3 up = rotate_inverse(state_.orientation, {0, 0, 1});
  const double scale = state_.gravity_weight / norm_m_s2;
  const Vec3 error{scale * (f[1] * up[2] - f[2] * up[1]), scale * (f[2] * up[0] - f[0] * up[2]),
                   scale * (f[0] * up[1] - f[1] * up[0])};
  // After a long gap at most the whole error is taken back.
  state_.orientation =
      multiply(state_.orientation, turn(error, std::min(1.0, config_.accelerometer_gain_per_s * elapsed_s)));
  learn_bias(error, elapsed_s);
}

void OrientationFilter::learn_bias(const Vec3& error, double elapsed_s) noexcept {
  const double max_rad_s = config_.gyro_bias_max_rad_s;
  state_.gyro_bias_saturated = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const double wanted_rad_s = state_.gyro_bias_rad_s[i] - config_.gyro_bias_gain_per_s2 * error[i] * elapsed_s;
    const double bias_rad_s = std::clamp(wanted_rad_s, -max_rad_s, max_rad_s);
    state_.gyro_bias_saturated |= bias_rad_s != wanted_rad_s;
    state_.gyro_bias_rad_s[i] = bias_rad_s;
  }
}

}  // namespace kadans

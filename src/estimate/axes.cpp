#include "axes.h"

#include <cmath>

namespace kadans {

Attitude attitude(const Axes& axes) noexcept {
  const auto& [x, y, z] = axes;
  const double level = std::sqrt(x[0] * x[0] + x[1] * x[1]);
  const double pitch_rad = std::atan2(-x[2], level);
  const double tilt_rad = std::atan2(std::sqrt(z[0] * z[0] + z[1] * z[1]), z[2]);
  // x points straight up or down: only yaw - roll, or yaw + roll, is defined.
  if (level < 1e-12) return {0, pitch_rad, std::atan2(-y[0], y[1]), tilt_rad};
  return {std::atan2(y[2], z[2]), pitch_rad, std::atan2(x[1], x[0]), tilt_rad};
}

Posture posture_of(const Vec3& up) noexcept {
  constexpr double lying = 0.6;
  if (up[2] > lying) return Posture::upright;
  if (up[0] < -lying) return Posture::prone;
  if (up[0] > lying) return Posture::supine;
  return up[1] < 0 ? Posture::left : Posture::right;
}

}  // namespace kadans

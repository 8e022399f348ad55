// A rotation as three axes: those of one frame, given in another. It needs more memory than a quaternion and rotates
// points faster; the estimator carries rotations along the legs this way.
#pragma once

#include <cmath>

#include "kadans/signal/status.h"

namespace kadans {

inline bool is_finite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

struct Axes {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

// q rotates body coordinates into world coordinates; unit length.
inline Axes axes_of(const Quat& q) noexcept {
  const auto [w, x, y, z] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

// Takes a vector given along the axes; returns it in the frame that the axes are given in.
inline Vec3 along(const Axes& axes, const Vec3& v) noexcept {
  return {axes.x[0] * v[0] + axes.y[0] * v[1] + axes.z[0] * v[2],
          axes.x[1] * v[0] + axes.y[1] * v[1] + axes.z[1] * v[2],
          axes.x[2] * v[0] + axes.y[2] * v[1] + axes.z[2] * v[2]};
}

inline Axes along(const Axes& outer, const Axes& inner) noexcept {
  return {along(outer, inner.x), along(outer, inner.y), along(outer, inner.z)};
}

// Roll, pitch and yaw as in model/kinematics.h; tilt, the angle between z and up.
struct Attitude {
  double roll_rad = 0, pitch_rad = 0, yaw_rad = 0, tilt_rad = 0;
};
Attitude attitude(const Axes& axes) noexcept;

// `up` is the upward unit vector in the base frame. A trunk that leans by more than 53 degrees lies.
Posture posture_of(const Vec3& up) noexcept;

}  // namespace kadans

// Forward kinematics of one foot, along the joints from the base to it. It costs a fraction of the whole robot's
// kinematics, so that the estimator can afford it in every tick. Rotations are carried as three axes, and a joint about
// x, y or z turns just two of them.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/signal/status.h"

namespace kadans {

inline bool is_finite(const Vec3& v) noexcept {
  return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]);
}

// A rotation as three axes: those of one frame, given in another. It needs more memory than a quaternion and rotates
// points faster; the estimator carries rotations along the legs this way.
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

class LegChain {
 public:
  // Throws std::invalid_argument when the model has no such link.
  LegChain(const RobotModel& model, std::size_t link);

  // base: the base's axes in the world. Afterwards axes() are the link's in the world, and point() is relative to the
  // base frame's origin, along the world's axes.
  void update(const JointStates& joints, const Axes& base) noexcept;

  const Axes& axes() const noexcept { return axes_; }
  Vec3 point(const Vec3& in_link_m) const noexcept {
    const Vec3 arm = along(axes_, in_link_m);
    return {position_m_[0] + arm[0], position_m_[1] + arm[1], position_m_[2] + arm[2]};
  }
  void pass_state(auto& bytes) noexcept { bytes(axes_, position_m_); }

 private:
  struct Segment {
    std::size_t joint = 0;
    bool prismatic = false;
    bool origin_turned = false;
    Vec3 origin_m{};
    Axes origin_axes;
    Vec3 axis{};
    int main_axis = 0;  // 0, 1, 2: along x, y, z; -1: any
    double sign = 1;    // along or against the main axis
  };

  std::vector<Segment> segments_;  // from the base outwards
  Axes axes_;
  Vec3 position_m_{};
};

}  // namespace kadans

// Where the links are: forward kinematics and centre of mass of a RobotModel. No allocation after construction, so that
// the estimator may call it in the tick.
#pragma once

#include <array>
#include <span>

#include "kadans/model/robot_model.h"

namespace kadans {

// Rotations are inlined: a body's motion is hundreds of them a tick.
inline Quat conjugate(const Quat& q) noexcept { return {q[0], -q[1], -q[2], -q[3]}; }

// v + 2 w (u x v) + 2 u x (u x v), with u the quaternion's vector part: exact when q is the identity.
inline Vec3 rotate(const Quat& q, const Vec3& v) noexcept {
  const Vec3 u{q[1], q[2], q[3]};
  const Vec3 first = cross(u, v);
  const Vec3 second = cross(u, first);
  return {v[0] + 2 * (q[0] * first[0] + second[0]), v[1] + 2 * (q[0] * first[1] + second[1]),
          v[2] + 2 * (q[0] * first[2] + second[2])};
}

inline Vec3 rotate_inverse(const Quat& q, const Vec3& v) noexcept { return rotate(conjugate(q), v); }

inline Quat multiply(const Quat& a, const Quat& b) noexcept {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

Quat normalized(const Quat& q) noexcept;
Quat from_axis_angle(const Vec3& unit_axis, double angle_rad) noexcept;
Quat from_roll_pitch_yaw(double roll_rad, double pitch_rad, double yaw_rad) noexcept;  // Rz(yaw) Ry(pitch) Rx(roll)
Vec3 roll_pitch_yaw(const Quat& q) noexcept;  // roll, pitch, yaw; pitch in [-pi/2, pi/2]

inline Vec3 transform(const Pose& pose, const Vec3& point) noexcept {
  const Vec3 turned = rotate(pose.orientation, point);
  return {pose.position_m[0] + turned[0], pose.position_m[1] + turned[1], pose.position_m[2] + turned[2]};
}

// b given in a's frame.
inline Pose compose(const Pose& a, const Pose& b) noexcept {
  return {transform(a, b.position_m), multiply(a.orientation, b.orientation)};
}

// How far the joint moves its child from its origin.
Pose motion_of(const Joint& joint, double position) noexcept;

class Kinematics {
 public:
  // Keeps a reference to the model, which must outlive it.
  explicit Kinematics(const RobotModel& model);

  // position_rad: one value per joint (radians, metres for prismatic joints). `base` is the pose of links[0].
  void update(std::span<const double> position_rad, const Pose& base = {}) noexcept;

  const Pose& link(std::size_t index) const noexcept { return poses_[index]; }  // as of the last update
  Vec3 com_m() const noexcept;                                                  // of the whole robot

 private:
  const RobotModel* model_;
  std::array<Pose, max_joints + 1> poses_;
};

}  // namespace kadans

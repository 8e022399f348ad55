// Where the links are: forward kinematics and centre of mass of a RobotModel. No allocation after construction, so that
// the estimator may call it in the tick.
#pragma once

#include <array>
#include <span>

#include "kadans/model/robot_model.h"

namespace kadans {

Vec3 rotate(const Quat& q, const Vec3& v) noexcept;
Vec3 rotate_inverse(const Quat& q, const Vec3& v) noexcept;
Quat multiply(const Quat& a, const Quat& b) noexcept;
Quat conjugate(const Quat& q) noexcept;
Quat normalized(const Quat& q) noexcept;
Quat from_axis_angle(const Vec3& unit_axis, double angle_rad) noexcept;
Quat from_roll_pitch_yaw(double roll_rad, double pitch_rad, double yaw_rad) noexcept;  // Rz(yaw) Ry(pitch) Rx(roll)
Vec3 roll_pitch_yaw(const Quat& q) noexcept;          // roll, pitch, yaw; pitch in [-pi/2, pi/2]
Pose compose(const Pose& a, const Pose& b) noexcept;  // b given in a's frame
Vec3 transform(const Pose& pose, const Vec3& point) noexcept;

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

// Inverse kinematics of a leg whose hip axes meet in one point: yaw, roll and pitch at the hip, a knee, an ankle pitch,
// the thigh and shank straight below each other at zero. In closed form.
//
// Positive angles turn about z, x, y, y, y; so a bent knee is positive, a hip that lifts the thigh forward negative.
#pragma once

#include <array>
#include <string>

#include "kadans/control/joint_axis.h"

namespace kadans {

enum LegJoint : std::size_t { hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, leg_joints };

class LegInverse {
 public:
  using Angles = std::array<double, leg_joints>;

  // Finds <side>_hip_yaw ... <side>_ankle_pitch among the axes, `side` being "l" or "r", and the lengths in the model.
  // Throws std::invalid_argument when one is missing.
  LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, const std::string& side);

  // The angles that put the ankle there, seen from the hip in the base frame, the hip turned by yaw_rad; the foot
  // parallel to the base. A place too far, or too near, is brought within reach along its line.
  Angles angles(const Vec3& ankle_m, double yaw_rad) const noexcept;

  const Vec3& hip_m() const noexcept { return hip_m_; }  // in the base frame
  double thigh_m() const noexcept { return thigh_m_; }
  double longest_m() const noexcept { return longest_m_; }  // from hip to ankle, the knee all but straight
  const JointAxis& axis(std::size_t joint) const noexcept { return axes_[joint]; }

 private:
  std::array<JointAxis, leg_joints> axes_;
  Vec3 hip_m_{};
  double thigh_m_ = 0, shank_m_ = 0, longest_m_ = 0, shortest_m_ = 0;
};

}  // namespace kadans

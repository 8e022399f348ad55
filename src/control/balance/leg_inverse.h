// Inverse kinematics of a leg, in closed form. The leg has yaw, roll and pitch at the hip, a knee and an ankle pitch.
// The hip's axes meet in one point. With all angles 0 the thigh and the shank hang straight down.
//
// The joints turn about z, x, y, y, y. So a bent knee is positive, and a hip pitch that lifts the thigh forward is
// negative.
#pragma once

#include <array>
#include <string>

#include "kadans/control/joint_axis.h"

namespace kadans {

enum LegJoint : std::size_t { hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, leg_joints };

class LegInverse {
 public:
  using Angles = std::array<double, leg_joints>;

  // Finds the joints <side>_hip_yaw ... <side>_ankle_pitch among the axes and the lengths in the model; `side` is "l"
  // or "r". Throws std::invalid_argument when a joint is missing, or the knee and the ankle do not lie below the hip.
  LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, const std::string& side);

  // The angles that put the ankle at ankle_m, from the hip in the base frame, with the hip turned by yaw_rad and the
  // foot parallel to the base. A place that is too far or too near is moved into reach, along the line from the hip.
  Angles angles(const Vec3& ankle_m, double yaw_rad) const noexcept;

  const Vec3& hip_m() const noexcept { return hip_m_; }  // in the base frame
  double thigh_m() const noexcept { return thigh_m_; }
  double longest_m() const noexcept { return longest_m_; }  // from hip to ankle with the knee almost straight
  const JointAxis& axis(std::size_t joint) const noexcept { return axes_[joint]; }

 private:
  std::array<JointAxis, leg_joints> axes_;
  Vec3 hip_m_{};
  double thigh_m_ = 0, shank_m_ = 0, longest_m_ = 0, shortest_m_ = 0;
};

}  // namespace kadans

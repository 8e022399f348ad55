// A leg that is led: where its foot shall be becomes angles, and a spring and a damper at each joint take them there.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "similarity.h"

namespace kadans {

// Inverse kinematics of a leg, in closed form. The leg has yaw, roll and pitch at the hip, a knee and an ankle pitch.
// The hip's axes meet in one point. With all angles 0 the thigh and the shank hang straight down.
//
// The joints turn about z, x, y, y, y. So a bent knee is positive, and a hip pitch that lifts the thigh forward is
// negative.
enum LegJoint : std::size_t { hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, leg_joints };
inline constexpr std::array<const char*, leg_joints> leg_joint_names{"hip_yaw", "hip_roll", "hip_pitch", "knee",
                                                                     "ankle_pitch"};

class LegInverse {
 public:
  using Angles = std::array<double, leg_joints>;

  // Finds the joints of the leg that ends at the link `foot` among the axes (leg_parts.h), and the lengths in the
  // model. Throws std::invalid_argument when a joint is missing or turns the other way, when the hip turns about other
  // axes first, or when the knee and the ankle do not lie below the hip.
  LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, std::size_t foot);

  // The angles that put the ankle at ankle_m, from the hip in the base frame, with the hip turned by yaw_rad and the
  // foot parallel to the base. A place that is too far or too near is moved into reach, along the line from the hip;
  // the leg is no longer than longest_m from hip to ankle.
  Angles angles(const Vec3& ankle_m, double yaw_rad,
                double longest_m = std::numeric_limits<double>::infinity()) const noexcept;

  const Vec3& hip_m() const noexcept { return hip_m_; }     // in the base frame
  double longest_m() const noexcept { return longest_m_; }  // from hip to ankle with the knee almost straight
  double length_m() const noexcept { return thigh_m_ + shank_m_; }
  const JointAxis& axis(std::size_t joint) const noexcept { return axes_[joint]; }

 private:
  std::array<JointAxis, leg_joints> axes_;
  Vec3 hip_m_{};
  double thigh_m_ = 0, shank_m_ = 0, longest_m_ = 0, shortest_m_ = 0;
};

// Parameters <part>.kp_Nm_per_rad and <part>.kd_Nms_per_rad of both legs.
struct LegGains {
  std::array<double, leg_joints> kp_Nm_per_rad{}, kd_Nms_per_rad{};
  void declare(const FittedDeclaration& declaration);
};

// A leg whose joints are led: a spring and a damper to targets, whose rates are low-passed.
struct LedLeg {
  LegInverse inverse;
  LegInverse::Angles target_rad{}, rate_rad_s{};
  LegInverse::Angles effort_Nm{};

  void declare_signals(Declaration& declaration);  // <joint>.target_rad, <joint>.effort_Nm
  void aim(const LegInverse::Angles& target_rad, double rate_max_rad_s, double dt_s) noexcept;
  LegInverse::Angles spring(const LegGains& gains, const ControlInput& input) const noexcept;  // torques to the targets
};

}  // namespace kadans

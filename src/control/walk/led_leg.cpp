#include "led_leg.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "control/balance/leg_parts.h"

namespace kadans {
namespace {

constexpr double rate_time_s = 0.006;  // low pass of the targets' rates
constexpr double straightest_knee_rad = 0.06, most_bent_knee_rad = 2.2;

double distance_m(double thigh_m, double shank_m, double knee_rad) {
  return std::sqrt(thigh_m * thigh_m + shank_m * shank_m + 2 * thigh_m * shank_m * std::cos(knee_rad));
}

}  // namespace

LegInverse::LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, std::size_t foot) {
  constexpr std::array<LegPart, leg_joints> wanted{LegPart::hip_yaw, LegPart::hip_roll, LegPart::hip_pitch,
                                                   LegPart::knee, LegPart::ankle_pitch};
  const std::vector<JointPart> parts = leg_parts(model, {&foot, 1});
  const std::string leg = "the leg of " + model.links[foot].name;
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const auto found = std::ranges::find_if(axes, [&](const JointAxis& a) { return parts[a.joint].part == wanted[i]; });
    if (found == axes.end()) throw std::invalid_argument(leg + " needs a joint as " + leg_joint_names[i]);
    if (parts[found->joint].sign < 0)
      throw std::invalid_argument(leg + ": joint " + found->name + " turns the other way; z, x, y, y, y are needed");
    if (i > 0 && found->joint < axes_[i - 1].joint)
      throw std::invalid_argument(leg + ": joint " + found->name + " comes before " + axes_[i - 1].name +
                                  "; from the hip on, z, x, y, y, y are needed");
    axes_[i] = *found;
  }
  const auto origin_m = [&](LegJoint joint) { return model.joints[axes_[joint].joint].origin.position_m; };
  hip_m_ = origin_m(hip_yaw);
  thigh_m_ = -origin_m(knee)[2];
  shank_m_ = -origin_m(ankle_pitch)[2];
  if (!(thigh_m_ > 0 && shank_m_ > 0)) throw std::invalid_argument("a leg's knee and ankle lie below its hip");
  longest_m_ = distance_m(thigh_m_, shank_m_, straightest_knee_rad);
  shortest_m_ = distance_m(thigh_m_, shank_m_, most_bent_knee_rad);
}

LegInverse::Angles LegInverse::angles(const Vec3& ankle_m, double yaw_rad, double longest_m) const noexcept {
  const double x_m = std::cos(yaw_rad) * ankle_m[0] + std::sin(yaw_rad) * ankle_m[1];
  const double y_m = std::cos(yaw_rad) * ankle_m[1] - std::sin(yaw_rad) * ankle_m[0];
  const double down_m = std::hypot(y_m, ankle_m[2]);
  const double reach_m = std::clamp(std::min(std::hypot(x_m, down_m), longest_m), shortest_m_, longest_m_);
  const double cosine = (reach_m * reach_m - thigh_m_ * thigh_m_ - shank_m_ * shank_m_) / (2 * thigh_m_ * shank_m_);
  const double bend_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double fore_rad = std::atan2(shank_m_ * std::sin(bend_rad), thigh_m_ + shank_m_ * std::cos(bend_rad));
  const double pitch_rad = std::atan2(-x_m, down_m) - fore_rad;
  return {yaw_rad, std::atan2(y_m, -ankle_m[2]), pitch_rad, bend_rad, -(pitch_rad + bend_rad)};
}

void LegGains::declare(const FittedDeclaration& d) {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const std::string name = leg_joint_names[i];
    d.tunable(name + ".kp_Nm_per_rad", "Nm/rad", 0, 20000, kp_Nm_per_rad[i], "Torque per position error.");
    d.tunable(name + ".kd_Nms_per_rad", "Nm s/rad", 0, 2000, kd_Nms_per_rad[i], "Torque per velocity error.");
  }
}

void LedLeg::declare_signals(Declaration& d) {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    d.signal({inverse.axis(i).name + ".target_rad", "rad", "Where it shall be."}, &target_rad[i]);
    d.signal({inverse.axis(i).name + ".effort_Nm", "Nm", "Torque asked for."}, &effort_Nm[i]);
  }
}

void LedLeg::aim(const LegInverse::Angles& new_target_rad, double rate_max_rad_s, double dt_s) noexcept {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const double step_rad_s = (new_target_rad[i] - target_rad[i]) / dt_s;
    const double limited_rad_s = std::clamp(step_rad_s, -rate_max_rad_s, rate_max_rad_s);
    rate_rad_s[i] += dt_s / rate_time_s * (limited_rad_s - rate_rad_s[i]);
    target_rad[i] = new_target_rad[i];
  }
}

LegInverse::Angles LedLeg::spring(const LegGains& gains, const ControlInput& input) const noexcept {
  LegInverse::Angles torque_Nm{};
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const JointState& joint = input.joints.joints[inverse.axis(i).joint];
    torque_Nm[i] = gains.kp_Nm_per_rad[i] * (target_rad[i] - joint.position_rad) +
                   gains.kd_Nms_per_rad[i] * (rate_rad_s[i] - joint.velocity_rad_s);
  }
  return torque_Nm;
}

}  // namespace kadans

#include "leg_inverse.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans {
namespace {

constexpr std::array<const char*, leg_joints> part_names{"hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch"};
constexpr double straightest_knee_rad = 0.06, most_bent_knee_rad = 2.2;

double distance_m(double thigh_m, double shank_m, double knee_rad) {
  return std::sqrt(thigh_m * thigh_m + shank_m * shank_m + 2 * thigh_m * shank_m * std::cos(knee_rad));
}

}  // namespace

LegInverse::LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, const std::string& side) {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const std::string name = side + "_" + part_names[i];
    const auto found = std::find_if(axes.begin(), axes.end(), [&](const JointAxis& a) { return a.name == name; });
    if (found == axes.end()) throw std::invalid_argument("a leg needs the joint " + name);
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

LegInverse::Angles LegInverse::angles(const Vec3& ankle_m, double yaw_rad) const noexcept {
  const double x_m = std::cos(yaw_rad) * ankle_m[0] + std::sin(yaw_rad) * ankle_m[1];
  const double y_m = std::cos(yaw_rad) * ankle_m[1] - std::sin(yaw_rad) * ankle_m[0];
  const double down_m = std::hypot(y_m, ankle_m[2]);
  const double reach_m = std::clamp(std::hypot(x_m, down_m), shortest_m_, longest_m_);
  const double cosine = (reach_m * reach_m - thigh_m_ * thigh_m_ - shank_m_ * shank_m_) / (2 * thigh_m_ * shank_m_);
  const double bend_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double fore_rad = std::atan2(shank_m_ * std::sin(bend_rad), thigh_m_ + shank_m_ * std::cos(bend_rad));
  const double pitch_rad = std::atan2(-x_m, down_m) - fore_rad;
  return {yaw_rad, std::atan2(y_m, -ankle_m[2]), pitch_rad, bend_rad, -(pitch_rad + bend_rad)};
}

}  // namespace kadans

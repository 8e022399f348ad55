#include "kadans/control/standing.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

constexpr double look_ahead_s = 0.001;
constexpr double lowest_com_m = 0.1;  // below, it does not stand

std::size_t foot_of(const ObjectSetup& setup, const char* option) {
  const std::string* const name = setup.options.find(option);
  if (name == nullptr) throw OptionError(option, "it needs the option '" + std::string(option) + "': a foot's link");
  const auto link = setup.model.find_link(*name);
  if (!link)
    throw OptionError(option, "there is no link '" + *name + "'" + did_you_mean(*name, setup.model.link_names()));
  return *link;
}

}  // namespace

Standing::Standing(const ObjectSetup& setup)
    : feet_{foot_of(setup, "left_foot"), foot_of(setup, "right_foot")},
      kinematics_(setup.model),
      joint_count_(setup.model.joints.size()) {}

Vec3 Standing::com_over_feet(const ControlInput& input, double ahead_s) noexcept {
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointState& joint = input.joints.joints[i];
    position_rad[i] = joint.position_rad + ahead_s * joint.velocity_rad_s;
  }
  const BaseStatus& base = input.status.base;
  const Vec3& w = base.angular_velocity_rad_s;
  const Quat upright = from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0);
  const Quat turn = normalized({1, 0.5 * ahead_s * w[0], 0.5 * ahead_s * w[1], 0.5 * ahead_s * w[2]});
  kinematics_.update({position_rad.data(), joint_count_}, {{}, multiply(upright, turn)});
  const Vec3 com = kinematics_.com_m();
  const Vec3& left = kinematics_.link(feet_[0]).position_m;
  const Vec3& right = kinematics_.link(feet_[1]).position_m;
  return {com[0] - (left[0] + right[0]) / 2, com[1] - (left[1] + right[1]) / 2, com[2] - (left[2] + right[2]) / 2};
}

bool Standing::update(const ControlInput& input) noexcept {
  const Vec3 next = com_over_feet(input, look_ahead_s);
  com_m_ = com_over_feet(input, 0);
  for (std::size_t k = 0; k < 3; ++k) velocity_m_s_[k] = (next[k] - com_m_[k]) / look_ahead_s;
  const double time_s = std::sqrt(std::max(com_m_[2], lowest_com_m) / standing_gravity_m_s2);
  dcm_x_m_ = com_m_[0] + time_s * velocity_m_s_[0];
  dcm_y_m_ = com_m_[1] + time_s * velocity_m_s_[1];
  return com_m_[2] > lowest_com_m && std::isfinite(dcm_x_m_) && std::isfinite(dcm_y_m_);
}

}  // namespace kadans

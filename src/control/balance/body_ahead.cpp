#include "body_ahead.h"

#include <string>

#include "signal/nearest_name.h"

namespace kadans {
namespace {

std::size_t foot_of(const ObjectSetup& setup, const char* option) {
  const std::string* const name = setup.options.find(option);
  if (name == nullptr) throw OptionError(option, "it needs the option '" + std::string(option) + "': a foot's link");
  const auto link = setup.model.find_link(*name);
  if (!link)
    throw OptionError(option, "there is no link '" + *name + "'" + did_you_mean(*name, setup.model.link_names()));
  return *link;
}

}  // namespace

BodyAhead::BodyAhead(const ObjectSetup& setup)
    : feet_{foot_of(setup, "left_foot"), foot_of(setup, "right_foot")},
      kinematics_(setup.model),
      joint_count_(setup.model.joints.size()) {}

void BodyAhead::update(const ControlInput& input, const Quat& upright, double ahead_s) noexcept {
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointState& joint = input.joints.joints[i];
    position_rad[i] = joint.position_rad + ahead_s * joint.velocity_rad_s;
  }
  const Vec3& w = input.status.base.angular_velocity_rad_s;
  const Quat turn = normalized({1, 0.5 * ahead_s * w[0], 0.5 * ahead_s * w[1], 0.5 * ahead_s * w[2]});
  kinematics_.update({position_rad.data(), joint_count_}, {{}, multiply(upright, turn)});
}

}  // namespace kadans

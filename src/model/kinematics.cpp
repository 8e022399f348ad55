#include "kadans/model/kinematics.h"

#include <algorithm>
#include <cassert>

namespace kadans {
namespace {

Pose motion(const Joint& joint, double position) noexcept {
  if (joint.type != JointType::prismatic) return {{}, from_axis_angle(joint.axis, position)};
  return {{joint.axis[0] * position, joint.axis[1] * position, joint.axis[2] * position}, {1, 0, 0, 0}};
}

}  // namespace

Kinematics::Kinematics(const RobotModel& model) : model_(&model), poses_{} {
  assert(model.joints.size() <= max_joints);
  const std::array<double, max_joints> zero{};
  update({zero.data(), model.joints.size()});
}

void Kinematics::update(std::span<const double> position_rad, const Pose& base) noexcept {
  assert(position_rad.size() >= model_->joints.size());
  poses_[0] = base;
  for (std::size_t i = 0; i < model_->joints.size(); ++i) {
    const Joint& joint = model_->joints[i];
    poses_[i + 1] = compose(compose(poses_[joint.parent], joint.origin), motion(joint, position_rad[i]));
  }
}

Vec3 Kinematics::com_m() const noexcept {
  Vec3 moment{};
  double mass_kg = 0;
  for (std::size_t i = 0; i < model_->links.size(); ++i) {
    const Inertia& inertia = model_->links[i].inertia;
    const Vec3 com = transform(poses_[i], inertia.com_m);
    for (std::size_t k = 0; k < 3; ++k) moment[k] += inertia.mass_kg * com[k];
    mass_kg += inertia.mass_kg;
  }
  if (!(mass_kg > 0)) return poses_[0].position_m;
  return {moment[0] / mass_kg, moment[1] / mass_kg, moment[2] / mass_kg};
}

}  // namespace kadans

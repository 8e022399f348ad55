#include "kadans/model/kinematics.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace kadans {

Quat normalized(const Quat& q) noexcept {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 0)) return {1, 0, 0, 0};
  return {q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm};
}

Quat from_axis_angle(const Vec3& unit_axis, double angle_rad) noexcept {
  const double s = std::sin(angle_rad / 2);
  return {std::cos(angle_rad / 2), unit_axis[0] * s, unit_axis[1] * s, unit_axis[2] * s};
}

Quat from_roll_pitch_yaw(double roll_rad, double pitch_rad, double yaw_rad) noexcept {
  const Quat roll = from_axis_angle({1, 0, 0}, roll_rad);
  const Quat pitch = from_axis_angle({0, 1, 0}, pitch_rad);
  const Quat yaw = from_axis_angle({0, 0, 1}, yaw_rad);
  return multiply(yaw, multiply(pitch, roll));
}

// From the rotation matrix's entries. Looking straight up or down only yaw - roll (or yaw + roll) is defined: roll is
// then 0.
Vec3 roll_pitch_yaw(const Quat& q) noexcept {
  const Vec3 x = rotate(q, {1, 0, 0});
  const Vec3 y = rotate(q, {0, 1, 0});
  const double level = std::hypot(x[0], x[1]);
  const double pitch_rad = std::atan2(-x[2], level);
  if (level < 1e-12) return {0, pitch_rad, std::atan2(-y[0], y[1])};
  const Vec3 z = rotate(q, {0, 0, 1});
  return {std::atan2(y[2], z[2]), pitch_rad, std::atan2(x[1], x[0])};
}

Pose motion_of(const Joint& joint, double position) noexcept {
  if (joint.type != JointType::prismatic) return {{}, from_axis_angle(joint.axis, position)};
  return {{joint.axis[0] * position, joint.axis[1] * position, joint.axis[2] * position}, {1, 0, 0, 0}};
}

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
    poses_[i + 1] = compose(compose(poses_[joint.parent], joint.origin), motion_of(joint, position_rad[i]));
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

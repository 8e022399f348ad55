#include "body_model.h"

#include <algorithm>
#include <cmath>

namespace kadans {

using Eigen::Index;
using Eigen::Vector3d;

Eigen::Matrix3d matrix_of(const Quat& q) noexcept {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
}

Vector3d turn_between(const Quat& from, const Quat& to) noexcept {
  Quat way = multiply(to, conjugate(from));
  if (way[0] < 0) way = {-way[0], -way[1], -way[2], -way[3]};
  const Vector3d axis(way[1], way[2], way[3]);
  const double sine = axis.norm();
  return sine < 1e-9 ? Vector3d(2 * axis) : Vector3d(axis * (2 * std::atan2(sine, way[0]) / sine));
}

Quat turned(const Quat& q, const Vector3d& by) noexcept {
  const double angle = by.norm();
  if (!(angle > 1e-12)) return q;
  return normalized(multiply(from_axis_angle(vec3(by / angle), angle), q));
}

void move_body(Pose& base, std::vector<double>& position_rad, Index base_size,
               const Eigen::Ref<const Eigen::VectorXd>& way) noexcept {
  if (base_size > 0) {
    for (std::size_t k = 0; k < 3; ++k) base.position_m[k] += way[static_cast<Index>(k)];
    base.orientation = turned(base.orientation, way.segment<3>(3));
  }
  for (std::size_t i = 0; i < position_rad.size(); ++i) position_rad[i] += way[base_size + static_cast<Index>(i)];
}

BodyModel::BodyModel(const RobotModel& model, Dynamics::Base base_kind, const std::vector<double>& rotor_inertia_kg_m2)
    : position_rad(model.joints.size(), 0.0),
      model_(&model),
      dynamics_(model, {.base = base_kind, .rotor_inertia_kg_m2 = rotor_inertia_kg_m2}),
      biases_(model.links.size()),
      joint_velocity_rad_s_(model.joints.size(), 0.0) {
  velocity.setZero(static_cast<Index>(dynamics_.size()));
  update();
}

void BodyModel::update() noexcept {
  Dynamics::BaseState state{.pose = base};
  if (base_size() > 0) {
    state.velocity_m_s = vec3(velocity.head<3>());
    state.angular_velocity_rad_s = vec3(velocity.segment<3>(3));
  }
  for (std::size_t i = 0; i < joint_velocity_rad_s_.size(); ++i)
    joint_velocity_rad_s_[i] = velocity[base_size() + static_cast<Index>(i)];
  dynamics_.update(position_rad, joint_velocity_rad_s_, state);
  find_biases();
}

// From the base outward, as in the first half of a Newton-Euler recursion.
void BodyModel::find_biases() noexcept {
  biases_[0] = {base_size() > 0 ? Vector3d(velocity.segment<3>(3)) : Vector3d::Zero(), Vector3d::Zero(),
                Vector3d::Zero()};
  for (std::size_t i = 0; i < model_->joints.size(); ++i) {
    const Joint& joint = model_->joints[i];
    const LinkBias& p = biases_[joint.parent];
    const Vector3d arm = eigen(link(i + 1).position_m) - eigen(link(joint.parent).position_m);
    const Vector3d rate = eigen(rotate(link(i + 1).orientation, joint.axis)) * joint_velocity_rad_s_[i];
    const Vector3d carried =
        p.acceleration_m_s2 + p.angular_rad_s2.cross(arm) + p.turning_rad_s.cross(p.turning_rad_s.cross(arm));
    if (joint.type == JointType::prismatic)
      biases_[i + 1] = {p.turning_rad_s, carried + 2 * p.turning_rad_s.cross(rate), p.angular_rad_s2};
    else
      biases_[i + 1] = {p.turning_rad_s + rate, carried, p.angular_rad_s2 + p.turning_rad_s.cross(rate)};
  }
}

Eigen::Vector<double, 6> BodyModel::bias(std::size_t index, const Vec3& point_in_link_m) const noexcept {
  const LinkBias& b = biases_[index];
  const Vector3d arm = eigen(rotate(link(index).orientation, point_in_link_m));
  Eigen::Vector<double, 6> result;
  result << b.acceleration_m_s2 + b.angular_rad_s2.cross(arm) + b.turning_rad_s.cross(b.turning_rad_s.cross(arm)),
      b.angular_rad_s2;
  return result;
}

Vector3d BodyModel::com_bias() const noexcept {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < model_->links.size(); ++i)
    sum += model_->links[i].inertia.mass_kg * bias(i, model_->links[i].inertia.com_m).head<3>();
  return dynamics_.mass_kg() > 0 ? Vector3d(sum / dynamics_.mass_kg()) : sum;
}

Pose base_over(const Kinematics& with_base_at_origin, const Quat& base, std::span<const StandPoint> feet) noexcept {
  Vec3 middle{};
  double forward_x = 0, forward_y = 0;
  for (const StandPoint& foot : feet) {
    const Pose& at = with_base_at_origin.link(foot.link);
    const Vec3 point = transform(at, foot.point_m), forward = rotate(at.orientation, {1, 0, 0});
    for (std::size_t k = 0; k < 3; ++k) middle[k] += point[k] / static_cast<double>(feet.size());
    forward_x += forward[0];
    forward_y += forward[1];
  }
  if (feet.empty()) {
    const Vec3 forward = rotate(base, {1, 0, 0});
    forward_x = forward[0];
    forward_y = forward[1];
  }
  const Quat back = from_axis_angle({0, 0, 1}, -std::atan2(forward_y, forward_x));
  return {rotate(back, {-middle[0], -middle[1], -middle[2]}), multiply(back, base)};
}

}  // namespace kadans

#include "body_geometry.h"

#include "kadans/model/kinematics.h"

namespace kadans {

using Eigen::Index;
using Eigen::Vector3d;

namespace {

Eigen::Matrix3d inertia_of(const Inertia& i) noexcept {
  Eigen::Matrix3d result;
  result << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  return result;
}

}  // namespace

BodyGeometry::BodyGeometry(const RobotModel& model, bool floating)
    : position_rad(model.joints.size(), 0.0),
      model_(&model),
      kinematics_(model),
      base_size_(floating ? 6 : 0),
      mass_kg_(model.mass_kg()),
      carried_kg_m_(model.links.size()),
      carried_kg_(model.links.size()),
      moving_(model.links.size()) {
  for (std::size_t i = model.links.size(); i-- > 0;) {
    carried_kg_[i] += model.links[i].inertia.mass_kg;
    if (i > 0) carried_kg_[model.joints[i - 1].parent] += carried_kg_[i];
  }
  update();
}

void BodyGeometry::update() noexcept {
  kinematics_.update(position_rad, base);
  for (std::size_t i = 0; i < carried_kg_m_.size(); ++i) {
    const Inertia& inertia = model_->links[i].inertia;
    carried_kg_m_[i] = inertia.mass_kg * eigen(transform(link(i), inertia.com_m));
  }
  for (std::size_t i = carried_kg_m_.size(); i-- > 1;) carried_kg_m_[model_->joints[i - 1].parent] += carried_kg_m_[i];
  com_m_ = vec3(mass_kg_ > 0 ? Vector3d(carried_kg_m_[0] / mass_kg_) : carried_kg_m_[0]);
}

void BodyGeometry::link_jacobian(std::size_t index, const Vec3& point_in_link_m,
                                 BodyModel::Jacobian& jacobian) const noexcept {
  jacobian.setZero();
  const Vector3d at = eigen(transform(link(index), point_in_link_m));
  if (base_size_ > 0) {
    const Vector3d arm = at - eigen(base.position_m);
    for (Index k = 0; k < 3; ++k) {
      jacobian(k, k) = jacobian(3 + k, 3 + k) = 1;
      jacobian.col(3 + k).head<3>() = Vector3d::Unit(k).cross(arm);
    }
  }
  for (std::size_t i = index; i > 0; i = model_->joints[i - 1].parent) {
    const Index column = base_size_ + static_cast<Index>(i - 1);
    const Vector3d turn = axis(i - 1);
    if (model_->joints[i - 1].type == JointType::prismatic) {
      jacobian.col(column).head<3>() = turn;
    } else {
      jacobian.col(column).head<3>() = turn.cross(at - eigen(link(i).position_m));
      jacobian.col(column).tail<3>() = turn;
    }
  }
}

void BodyGeometry::com_jacobian(BodyModel::Jacobian& jacobian) const noexcept {
  jacobian.topRows<3>().setZero();
  if (!(mass_kg_ > 0)) return;
  if (base_size_ > 0) {
    const Vector3d arm = eigen(com_m_) - eigen(base.position_m);
    for (Index k = 0; k < 3; ++k) {
      jacobian(k, k) = 1;
      jacobian.col(3 + k).head<3>() = Vector3d::Unit(k).cross(arm);
    }
  }
  for (std::size_t i = 1; i < carried_kg_.size(); ++i) {
    const Vector3d turn = axis(i - 1), lever = carried_kg_m_[i] - carried_kg_[i] * eigen(link(i).position_m);
    jacobian.col(base_size_ + static_cast<Index>(i - 1)).head<3>() =
        (model_->joints[i - 1].type == JointType::prismatic ? Vector3d(carried_kg_[i] * turn) : turn.cross(lever)) /
        mass_kg_;
  }
}

// From the base outward, as in the first half of a Newton-Euler recursion.
void BodyGeometry::move_links(const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration) noexcept {
  moving_[0] = {velocity.segment<3>(3), acceleration.head<3>(), acceleration.segment<3>(3)};
  for (std::size_t i = 0; i < model_->joints.size(); ++i) {
    const Joint& joint = model_->joints[i];
    const Moving& p = moving_[joint.parent];
    const Index at = base_size_ + static_cast<Index>(i);
    const Vector3d arm = eigen(link(i + 1).position_m) - eigen(link(joint.parent).position_m), along = axis(i);
    const Vector3d rate = along * velocity[at], change = along * acceleration[at];
    const Vector3d carried =
        p.acceleration_m_s2 + p.angular_rad_s2.cross(arm) + p.turning_rad_s.cross(p.turning_rad_s.cross(arm));
    if (joint.type == JointType::prismatic)
      moving_[i + 1] = {p.turning_rad_s, carried + 2 * p.turning_rad_s.cross(rate) + change, p.angular_rad_s2};
    else
      moving_[i + 1] = {p.turning_rad_s + rate, carried, p.angular_rad_s2 + p.turning_rad_s.cross(rate) + change};
  }
}

Eigen::Vector<double, 6> BodyGeometry::ground_wrench(const Eigen::VectorXd& velocity,
                                                     const Eigen::VectorXd& acceleration) noexcept {
  move_links(velocity, acceleration);
  Eigen::Vector<double, 6> wrench = Eigen::Vector<double, 6>::Zero();
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    const Moving& m = moving_[i];
    const Inertia& inertia = model_->links[i].inertia;
    const Eigen::Matrix3d axes = matrix_of(link(i).orientation);
    const Vector3d arm = axes * eigen(inertia.com_m), at = eigen(link(i).position_m) + arm;
    const Vector3d force =
        inertia.mass_kg * (m.acceleration_m_s2 + m.angular_rad_s2.cross(arm) +
                           m.turning_rad_s.cross(m.turning_rad_s.cross(arm)) + Vector3d(0, 0, body_gravity_m_s2));
    const Eigen::Matrix3d own = axes * inertia_of(inertia) * axes.transpose();
    wrench.head<3>() += force;
    wrench.tail<3>() += at.cross(force) + own * m.angular_rad_s2 + m.turning_rad_s.cross(own * m.turning_rad_s);
  }
  return wrench;
}

}  // namespace kadans

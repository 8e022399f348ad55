// Bodies in motion: where the links are, what accelerates them, and what forces that takes.
#include "kadans/model/dynamics.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

#include <Eigen/Geometry>

namespace kadans {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d vector(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }

Matrix3d rotation(const Quat& q) noexcept {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  Matrix3d r;
  r << 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),  //
      2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),   //
      2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y);
  return r;
}

Matrix3d tensor(const Inertia& i) noexcept {
  Matrix3d t;
  t << i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz;
  return t;
}

}  // namespace

Dynamics::Dynamics(const RobotModel& model, Config config)
    : model_(&model),
      config_(std::move(config)),
      gravity_m_s2_(vector(config_.gravity_m_s2)),
      joint_count_(model.joints.size()),
      base_size_(config_.base == Base::floating ? 6 : 0),
      kinematics_(model),
      velocity_rad_s_(joint_count_, 0.0),
      bodies_(model.links.size()) {
  if (!config_.rotor_inertia_kg_m2.empty() && config_.rotor_inertia_kg_m2.size() != joint_count_) {
    throw std::invalid_argument("rotor_inertia_kg_m2 has " + std::to_string(config_.rotor_inertia_kg_m2.size()) +
                                " values, the model has " + std::to_string(joint_count_) + " joints");
  }
  const auto n = static_cast<Eigen::Index>(size());
  mass_.setZero(n, n);
  bias_.setZero(n);
  gravity_.setZero(n);
  acceleration_.setZero(n);
  const std::vector<double> zero(joint_count_, 0.0);
  update(zero, zero, {});
}

void Dynamics::update(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
                      const BaseState& base) noexcept {
  assert(position_rad.size() >= joint_count_ && velocity_rad_s.size() >= joint_count_);
  kinematics_.update(position_rad, base.pose);
  std::copy_n(velocity_rad_s.begin(), joint_count_, velocity_rad_s_.begin());
  bodies_[0].angular_velocity = vector(base.angular_velocity_rad_s);
  for (std::size_t i = 0; i < bodies_.size(); ++i) place(i);
  newton_euler(nullptr, bias_);
  gather_composites();
  fill_mass();
  fill_gravity();
}

void Dynamics::place(std::size_t link) noexcept {
  const Pose& pose = kinematics_.link(link);
  const Matrix3d r = rotation(pose.orientation);
  const Inertia& inertia = model_->links[link].inertia;
  Body& body = bodies_[link];
  body.origin = vector(pose.position_m);
  body.axis = link == 0 ? Vector3d::Zero() : Vector3d(r * vector(model_->joints[link - 1].axis));
  body.com_arm = r * vector(inertia.com_m);
  body.inertia = r * tensor(inertia) * r.transpose();
}

// Section 2.11's motion of a body carried by its parent and moved by its own joint, in plain vectors.
void Dynamics::accelerate(std::size_t link, double velocity, double acceleration) noexcept {
  Body& body = bodies_[link];
  const Body& carrier = bodies_[parent(link)];
  const Vector3d arm = body.origin - carrier.origin;
  const Vector3d& w = carrier.angular_velocity;
  body.acceleration = carrier.acceleration + carrier.angular_acceleration.cross(arm) + w.cross(w.cross(arm));
  body.angular_velocity = w;
  body.angular_acceleration = carrier.angular_acceleration;
  if (prismatic(link)) {
    body.acceleration += 2 * velocity * w.cross(body.axis) + acceleration * body.axis;
  } else {
    body.angular_velocity += velocity * body.axis;
    body.angular_acceleration += velocity * w.cross(body.axis) + acceleration * body.axis;
  }
}

void Dynamics::newton_euler(const Eigen::VectorXd* acceleration, Eigen::Ref<Eigen::VectorXd> force) noexcept {
  Body& base = bodies_[0];
  base.acceleration = -gravity_m_s2_;
  base.angular_acceleration.setZero();
  if (acceleration != nullptr && base_size_ > 0) {
    base.acceleration += acceleration->head<3>();
    base.angular_acceleration = acceleration->segment<3>(3);
  }
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (i > 0) accelerate(i, velocity_rad_s_[i - 1], acceleration == nullptr ? 0.0 : (*acceleration)[index(i)]);
    Body& body = bodies_[i];
    const Vector3d& w = body.angular_velocity;
    const Vector3d at_com =
        body.acceleration + body.angular_acceleration.cross(body.com_arm) + w.cross(w.cross(body.com_arm));
    body.force = model_->links[i].inertia.mass_kg * at_com;
    body.moment = body.inertia * body.angular_acceleration + w.cross(body.inertia * w) + body.com_arm.cross(body.force);
  }
  for (std::size_t i = bodies_.size(); i-- > 1;) {
    const Body& body = bodies_[i];
    Body& carrier = bodies_[parent(i)];
    force[index(i)] = body.axis.dot(prismatic(i) ? body.force : body.moment);
    carrier.force += body.force;
    carrier.moment += body.moment + (body.origin - carrier.origin).cross(body.force);
  }
  if (base_size_ > 0) {
    force.head<3>() = base.force;
    force.segment<3>(3) = base.moment;
  }
}

void Dynamics::inverse_dynamics(const Eigen::Ref<const Eigen::VectorXd>& acceleration,
                                Eigen::Ref<Eigen::VectorXd> force) noexcept {
  acceleration_ = acceleration;
  newton_euler(&acceleration_, force);
  for (std::size_t i = 0; i < config_.rotor_inertia_kg_m2.size(); ++i) {
    force[index(i + 1)] += config_.rotor_inertia_kg_m2[i] * acceleration_[index(i + 1)];
  }
}

}  // namespace kadans

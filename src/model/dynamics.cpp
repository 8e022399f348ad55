// The robot as a tree of KDL's, and what is asked of it.
//
// The base hangs on six massless joints, three that slide and three that turn, in a frame that stands still and, at
// each update, coincides with the base's: all six are at zero. Then the sliding ones' accelerations are those of the
// base's origin, with gravity taken off; its steady velocity has no effect. The turning ones, about x, y and z in this
// order, have the angular velocity's parts for rates, but each carries the next ones' axes along, which gives products
// of rates in the angular acceleration.
#include "kadans/model/dynamics.h"

#include <algorithm>
#include <cassert>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>
#include <kdl/tree.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>

namespace kadans {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr Index virtual_joints = 6;

Vector3d vector(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }
KDL::Vector kdl_vector(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }

Matrix3d rotation(const Quat& q) noexcept { return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix(); }

// Short enough that no std::string of it allocates.
std::string segment(std::size_t link) { return std::to_string(link); }

KDL::RigidBodyInertia kdl_inertia(const Inertia& i) {
  return KDL::RigidBodyInertia(i.mass_kg, kdl_vector(i.com_m),
                               KDL::RotationalInertia(i.xx, i.yy, i.zz, i.xy, i.xz, i.yz));
}

KDL::Tree kdl_tree(const RobotModel& model, const std::vector<double>& rotors_kg_m2) {
  using KDL::Joint;
  KDL::Tree tree("still");
  std::string carrier = "still";
  for (const auto type : {Joint::TransX, Joint::TransY, Joint::TransZ, Joint::RotX, Joint::RotY, Joint::RotZ}) {
    const bool last = type == Joint::RotZ;
    const std::string name = last ? segment(0) : "virtual" + std::to_string(type);
    const auto inertia = last ? kdl_inertia(model.links[0].inertia) : KDL::RigidBodyInertia::Zero();
    tree.addSegment(KDL::Segment(name, Joint(type), KDL::Frame::Identity(), inertia), carrier);
    carrier = name;
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const auto& [position_m, q] = model.joints[i].origin;
    const KDL::Frame origin(KDL::Rotation::Quaternion(q[1], q[2], q[3], q[0]), kdl_vector(position_m));
    const auto type = model.joints[i].type == JointType::prismatic ? Joint::TransAxis : Joint::RotAxis;
    const Joint joint(origin.p, origin.M * kdl_vector(model.joints[i].axis), type, 1, 0,
                      rotors_kg_m2.empty() ? 0.0 : rotors_kg_m2[i]);
    tree.addSegment(KDL::Segment(segment(i + 1), joint, origin, kdl_inertia(model.links[i + 1].inertia)),
                    segment(model.joints[i].parent));
  }
  return tree;
}

}  // namespace

struct Dynamics::Tree {
  Tree(const RobotModel& model, const std::vector<double>& rotors_kg_m2) : tree(kdl_tree(model, rotors_kg_m2)) {
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const KDL::TreeElement& element = tree.getSegment(segment(i))->second;
      parts.push_back({&element, i > 0 ? model.joints[i - 1].parent : 0});
    }
  }

  void place(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
             const BaseState& at) noexcept {
    base = rotation(at.pose.orientation);
    std::ranges::copy(position_rad, position.data.begin() + virtual_joints);
    std::ranges::copy(velocity_rad_s, velocity.data.begin() + virtual_joints);
    velocity.data.segment<3>(3) = base.transpose() * vector(at.angular_velocity_rad_s);
  }

  // `force` for `acceleration`, which is lost; the base's six first, both in world axes. No gravity.
  void solve() noexcept {
    auto linear = acceleration.data.head<3>(), angular = acceleration.data.segment<3>(3);
    const Vector3d w = velocity.data.segment<3>(3);
    linear = base.transpose() * Vector3d(linear);
    angular = base.transpose() * Vector3d(angular) - Vector3d(w.y() * w.z(), -w.x() * w.z(), w.x() * w.y());
    [[maybe_unused]] const int error = newton_euler.CartToJnt(position, velocity, acceleration, no_push, force);
    assert(error == KDL::SolverI::E_NOERROR);
    force.data.head<3>() = base * Vector3d(force.data.head<3>());
    force.data.segment<3>(3) = base * Vector3d(force.data.segment<3>(3));
  }

  // The mass matrix with a floating base, as KDL::ChainDynParam has it for chains (Featherstone 2008, section 6.2):
  // from composite bodies, each a link with all that hangs on it, the wrench that a unit acceleration takes is carried
  // to all the joints on the way to the base.
  void fill(Eigen::MatrixXd& mass) noexcept {
    for (Part& part : parts) {
      const KDL::Segment& segment = part.element->segment;
      const double at = position(part.element->q_nr);
      part.pose = segment.pose(at);
      part.axis = part.pose.M.Inverse(segment.twist(at, 1));
      part.composite = segment.getInertia();
    }
    for (std::size_t i = parts.size(); i-- > 1;) {
      KDL::RigidBodyInertia& carrier = parts[parts[i].parent].composite;
      carrier = carrier + parts[i].pose * parts[i].composite;
    }
    for (Index i = 0; i < virtual_joints; ++i) {
      const KDL::Vector axis(base(i % 3, 0), base(i % 3, 1), base(i % 3, 2)), none = KDL::Vector::Zero();
      mass.col(i).head<6>() = in_world(parts[0].composite * (i < 3 ? KDL::Twist(axis, none) : KDL::Twist(none, axis)));
    }
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const auto column = static_cast<Index>(parts[i].element->q_nr);
      KDL::Wrench wrench = parts[i].composite * parts[i].axis;
      mass(column, column) = dot(parts[i].axis, wrench) + parts[i].element->segment.getJoint().getInertia();
      for (std::size_t k = i; k > 0;) {
        wrench = parts[k].pose * wrench;
        k = parts[k].parent;
        if (k > 0) mass(static_cast<Index>(parts[k].element->q_nr), column) = dot(parts[k].axis, wrench);
      }
      mass.col(column).head<6>() = in_world(wrench);
    }
    mass.triangularView<Eigen::StrictlyLower>() = mass.transpose();  // symmetric to the last bit
  }

  Eigen::Vector<double, 6> in_world(const KDL::Wrench& wrench) const noexcept {
    Eigen::Vector<double, 6> result;
    result << base * Eigen::Map<const Vector3d>(wrench.force.data),
        base * Eigen::Map<const Vector3d>(wrench.torque.data);
    return result;
  }

  // A link, in its own axes.
  struct Part {
    const KDL::TreeElement* element;
    std::size_t parent;
    KDL::Frame pose{};  // in the parent
    KDL::Twist axis{};  // of its joint
    KDL::RigidBodyInertia composite = KDL::RigidBodyInertia::Zero();
  };

  KDL::Tree tree;
  std::vector<Part> parts;  // one a link
  KDL::TreeIdSolver_RNE newton_euler{tree, KDL::Vector::Zero()};
  KDL::JntArray position{tree.getNrOfJoints()}, velocity{position}, acceleration{position};
  KDL::JntArray force{position};
  const KDL::WrenchMap no_push;
  Matrix3d base;  // its axes in the world
};

Dynamics::Dynamics(const RobotModel& model, const Config& config)
    : model_(&model),
      gravity_m_s2_(vector(config.gravity_m_s2)),
      joint_count_(model.joints.size()),
      base_size_(config.base == Base::floating ? virtual_joints : 0),
      kinematics_(model) {
  if (!config.rotor_inertia_kg_m2.empty() && config.rotor_inertia_kg_m2.size() != joint_count_) {
    throw std::invalid_argument("rotor_inertia_kg_m2 has " + std::to_string(config.rotor_inertia_kg_m2.size()) +
                                " values, the model has " + std::to_string(joint_count_) + " joints");
  }
  tree_ = std::make_unique<Tree>(model, config.rotor_inertia_kg_m2);
  const auto n = static_cast<Index>(size());
  whole_.setZero(tree_->force.data.size(), tree_->force.data.size());
  mass_.setZero(n, n);
  bias_.setZero(n);
  gravity_.setZero(n);
  const std::vector<double> zero(joint_count_, 0.0);
  update(zero, zero, {});
}

Dynamics::Dynamics(Dynamics&&) noexcept = default;
Dynamics& Dynamics::operator=(Dynamics&&) noexcept = default;
Dynamics::~Dynamics() = default;

void Dynamics::update(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
                      const BaseState& base) noexcept {
  assert(position_rad.size() >= joint_count_ && velocity_rad_s.size() >= joint_count_);
  kinematics_.update(position_rad, base.pose);
  tree_->place(position_rad.first(joint_count_), velocity_rad_s.first(joint_count_), base);
  Eigen::VectorXd& acceleration = tree_->acceleration.data;
  const auto n = static_cast<Index>(size());
  tree_->fill(whole_);
  acceleration.setZero();
  acceleration.head<3>() = -gravity_m_s2_;
  tree_->solve();
  bias_ = tree_->force.data.tail(n);
  mass_ = whole_.bottomRightCorner(n, n);
  gravity_.noalias() = -whole_.topRows<3>().rightCols(n).transpose() * gravity_m_s2_;
}

void Dynamics::inverse_dynamics(const Eigen::Ref<const Eigen::VectorXd>& acceleration,
                                Eigen::Ref<Eigen::VectorXd> force) noexcept {
  const auto n = static_cast<Index>(size());
  tree_->acceleration.data.setZero();
  tree_->acceleration.data.tail(n) = acceleration;
  tree_->acceleration.data.head<3>() -= gravity_m_s2_;
  tree_->solve();
  force = tree_->force.data.tail(n);
}

// Turning joint k turns the lever of every joint that it carries; sliding it moves them without a change.
void Dynamics::gravity_gradient(Eigen::Ref<Eigen::MatrixXd> gradient) const noexcept {
  gradient.setZero();
  for (std::size_t i = joint_count_; i > 0; --i) {
    const auto row = static_cast<Index>(i - 1);
    const Vector3d lever = whole_.block<3, 1>(0, virtual_joints + row);  // times mass
    for (std::size_t k = i; k > 0; k = model_->joints[k - 1].parent) {
      const Joint& joint = model_->joints[k - 1];
      if (joint.type == JointType::prismatic) continue;
      const Vector3d axis = vector(rotate(link(k).orientation, joint.axis));
      const auto column = static_cast<Index>(k - 1);
      gradient(row, column) = gradient(column, row) = -gravity_m_s2_.dot(axis.cross(lever));
    }
  }
}

// Not KDL's solver: it numbers the joints of its copy of the tree anew, depth first, whatever the model's order is.
void Dynamics::link_jacobian(std::size_t link, const Vec3& point_in_link_m,
                             Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept {
  const Vector3d point = vector(transform(kinematics_.link(link), point_in_link_m));
  const auto turn = [&](Index column, const Vector3d& axis, const Pose& about) {
    jacobian.col(column) << axis.cross(point - vector(about.position_m)), axis;
  };
  jacobian.setZero();
  for (std::size_t i = link; i > 0; i = model_->joints[i - 1].parent) {
    const Joint& joint = model_->joints[i - 1];
    const Vector3d axis = vector(rotate(kinematics_.link(i).orientation, joint.axis));
    const auto column = static_cast<Index>(base_size_ + i - 1);
    if (joint.type == JointType::prismatic)
      jacobian.col(column).head<3>() = axis;
    else
      turn(column, axis, kinematics_.link(i));
  }
  if (base_size_ == 0) return;
  for (Index k = 0; k < 3; ++k) {
    jacobian(k, k) = 1;
    turn(3 + k, Vector3d::Unit(k), kinematics_.link(0));
  }
}

void Dynamics::com_jacobian(Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept {
  jacobian = whole_.topRows<3>().rightCols(static_cast<Index>(size()));
  if (mass_kg() > 0) jacobian /= mass_kg();
}

Vector3d Dynamics::mass_times_com_arm() const noexcept { return {whole_(5, 1), whole_(3, 2), whole_(4, 0)}; }

Vec3 Dynamics::com_m() const noexcept {
  Vector3d com = vector(link(0).position_m);
  if (mass_kg() > 0) com += mass_times_com_arm() / mass_kg();
  return {com.x(), com.y(), com.z()};
}

double Dynamics::potential_energy_J() const noexcept {
  return -gravity_m_s2_.dot(mass_kg() * vector(link(0).position_m) + mass_times_com_arm());
}

}  // namespace kadans

// Rigid-body dynamics of a RobotModel, with a bolted or a floating base:
//
//   M(q) dv + h(q, v) = tau
//
// v holds the size() generalised velocities. A floating base comes first: the linear velocity of the base frame's
// origin and the angular velocity, both in world axes (m/s, rad/s). The joints follow in the model's order (rad/s, or
// m/s for a prismatic joint). tau has the same order: the force on the base and the moment about the base frame's
// origin (N, Nm), then the joint torques (Nm, or N). dv is the plain time derivative of v, so the acceleration of the
// origin is what a camera would see. Mimic joints count as joints of their own.
//
// Orocos KDL computes the forces by its recursive Newton-Euler algorithm for trees, and the mass matrix from its
// inertias of composite bodies, as its own solver for chains does. Gravity and the centre of mass are read from the
// rows that the mass matrix has for a floating base. An update takes about 14 us for TULip. The inertia of a drive's
// rotor, reflected to its joint, is added to the diagonal (Featherstone, Rigid Body Dynamics Algorithms, 2008, section
// 9.6); the rotors' gyroscopic torques are left out.
//
// One owner, any thread. Nothing but the constructor allocates or throws. Values that are not finite give results that
// are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kadans/model/kinematics.h"
#include "kadans/model/robot_model.h"

namespace kadans {

class Dynamics {
 public:
  enum class Base : std::uint8_t { fixed, floating };
  struct Config {
    Base base = Base::fixed;
    Vec3 gravity_m_s2{0, 0, -9.81};           // world axes
    std::vector<double> rotor_inertia_kg_m2;  // reflected to the joint, one per joint; empty: none
  };
  // Of the base link's frame, in the world. A fixed base may have any pose and velocity, but has no acceleration.
  struct BaseState {
    Pose pose;
    Vec3 velocity_m_s{}, angular_velocity_rad_s{};  // world axes
  };

  // Keeps a reference to the model, which must outlive it. Throws std::invalid_argument unless there is one rotor
  // inertia per joint, or none.
  Dynamics(const RobotModel& model, const Config& config);
  explicit Dynamics(const RobotModel& model) : Dynamics(model, Config()) {}
  Dynamics(Dynamics&&) noexcept;
  Dynamics& operator=(Dynamics&&) noexcept;
  ~Dynamics();

  // One position and one velocity a joint. All results below hold until the next update.
  void update(std::span<const double> position_rad, std::span<const double> velocity_rad_s,
              const BaseState& base) noexcept;

  std::size_t size() const noexcept { return base_size_ + joint_count_; }  // degrees of freedom, n
  std::size_t base_size() const noexcept { return base_size_; }            // 6 or 0

  // n x n, symmetric, in full.
  const Eigen::MatrixXd& mass_matrix() const noexcept { return mass_; }
  // n: Coriolis, centrifugal and gravity forces, h.
  const Eigen::VectorXd& bias() const noexcept { return bias_; }
  // n: the forces that hold the robot against gravity when it is at rest.
  const Eigen::VectorXd& gravity() const noexcept { return gravity_; }
  // How gravity() changes with the joints' positions: joint_count x joint_count, symmetric, Nm/rad. The second
  // derivative of the potential energy.
  void gravity_gradient(Eigen::Ref<Eigen::MatrixXd> gradient) const noexcept;
  // tau for dv, both n.
  void inverse_dynamics(const Eigen::Ref<const Eigen::VectorXd>& acceleration,
                        Eigen::Ref<Eigen::VectorXd> force) noexcept;

  // 6 x n: velocity of a point of a link (rows 0..2, m/s) and of the link's turning (rows 3..5, rad/s), world axes.
  void link_jacobian(std::size_t link, const Vec3& point_in_link_m,
                     Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept;
  // 3 x n: velocity of the centre of mass, world axes.
  void com_jacobian(Eigen::Ref<Eigen::MatrixXd> jacobian) const noexcept;
  Vec3 com_m() const noexcept;
  double mass_kg() const noexcept { return whole_(0, 0); }
  double potential_energy_J() const noexcept;  // 0 with the centre of mass at the world's origin
  const Pose& link(std::size_t index) const noexcept { return kinematics_.link(index); }

 private:
  struct Tree;  // KDL's

  Eigen::Vector3d mass_times_com_arm() const noexcept;  // arm: from the base frame's origin

  const RobotModel* model_;
  Eigen::Vector3d gravity_m_s2_;
  std::size_t joint_count_, base_size_;
  Kinematics kinematics_;
  std::unique_ptr<Tree> tree_;
  Eigen::MatrixXd whole_;  // the mass matrix with a floating base, whether it floats or not
  Eigen::MatrixXd mass_;
  Eigen::VectorXd bias_, gravity_;
};

}  // namespace kadans

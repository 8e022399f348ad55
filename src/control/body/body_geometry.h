// The robot as foresight computes with it: where its links and its centre of mass are, how they move with the joints,
// and what the ground must give for a motion. A small part of dynamics.h at a small part of its cost: there is no mass
// matrix.
//
// One owner, any thread. Nothing but the constructor allocates or throws.
#pragma once

#include <vector>

#include "body_layout.h"
#include "body_model.h"

namespace kadans {

class BodyGeometry {
 public:
  BodyGeometry(const RobotModel& model, bool floating);

  Pose base;                         // of links[0], in the task frame
  std::vector<double> position_rad;  // of the joints
  void update() noexcept;            // computes what follows from these
  void move(const Eigen::Ref<const Eigen::VectorXd>& way) noexcept { move_body(base, position_rad, base_size_, way); }

  Eigen::Index size() const noexcept { return base_size_ + static_cast<Eigen::Index>(position_rad.size()); }
  Eigen::Index base_size() const noexcept { return base_size_; }
  const Pose& link(std::size_t index) const noexcept { return kinematics_.link(index); }
  const Vec3& com_m() const noexcept { return com_m_; }
  double mass_kg() const noexcept { return mass_kg_; }
  // As those of Dynamics.
  void link_jacobian(std::size_t link, const Vec3& point_in_link_m, BodyModel::Jacobian& jacobian) const noexcept;
  void com_jacobian(BodyModel::Jacobian& jacobian) const noexcept;  // in the rows 0..2
  // The force, and the moment about the task frame's origin, that the ground gives to a floating base that moves like
  // this: generalised velocity and acceleration, as in dynamics.h.
  Eigen::Vector<double, 6> ground_wrench(const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration) noexcept;

 private:
  struct Moving {
    Eigen::Vector3d turning_rad_s, acceleration_m_s2, angular_rad_s2;
  };
  Eigen::Vector3d axis(std::size_t joint) const noexcept {
    return eigen(rotate(link(joint + 1).orientation, model_->joints[joint].axis));
  }
  void move_links(const Eigen::VectorXd& velocity, const Eigen::VectorXd& acceleration) noexcept;

  const RobotModel* model_;
  Kinematics kinematics_;
  Eigen::Index base_size_;
  double mass_kg_;
  Vec3 com_m_{};
  std::vector<Eigen::Vector3d> carried_kg_m_;  // by link: mass times place of the link and all that hangs on it
  std::vector<double> carried_kg_;
  std::vector<Moving> moving_;
};

}  // namespace kadans

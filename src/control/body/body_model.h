// The robot as whole-body control computes with it: its state in the task frame, its dynamics, and how points and the
// centre of mass accelerate by velocity alone.
//
// The task frame of a floating base is where the robot stood when it began: the origin on the ground in the middle of
// the feet in contact, x forward along the ground where the feet point, z up. That of a fixed base is the base's.
//
// One owner, any thread. Nothing but the constructor allocates or throws.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "kadans/model/dynamics.h"

namespace kadans {

inline Eigen::Vector3d eigen(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }
inline Vec3 vec3(const Eigen::Vector3d& v) noexcept { return {v.x(), v.y(), v.z()}; }
Eigen::Matrix3d matrix_of(const Quat& q) noexcept;
// The rotation vector that turns `from` into `to`, in the axes of the frame in which both are given.
Eigen::Vector3d turn_between(const Quat& from, const Quat& to) noexcept;
// `q`, turned by this rotation vector.
Quat turned(const Quat& q, const Eigen::Vector3d& by) noexcept;
// Moves a base of this size (6 or 0) and the joints on by a generalised velocity times a time.
void move_body(Pose& base, std::vector<double>& position_rad, Eigen::Index base_size,
               const Eigen::Ref<const Eigen::VectorXd>& way) noexcept;

class BodyModel {
 public:
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

  BodyModel(const RobotModel& model, Dynamics::Base base, const std::vector<double>& rotor_inertia_kg_m2);

  Pose base;                         // of links[0], in the task frame
  std::vector<double> position_rad;  // of the joints
  Eigen::VectorXd velocity;          // generalised, as in dynamics.h
  void update() noexcept;            // computes what follows from these
  void move(const Eigen::Ref<const Eigen::VectorXd>& way) noexcept { move_body(base, position_rad, base_size(), way); }

  const Dynamics& dynamics() const noexcept { return dynamics_; }
  Eigen::Index size() const noexcept { return velocity.size(); }
  Eigen::Index base_size() const noexcept { return static_cast<Eigen::Index>(dynamics_.base_size()); }
  const Pose& link(std::size_t index) const noexcept { return dynamics_.link(index); }
  Vec3 com_m() const noexcept { return dynamics_.com_m(); }
  // Of a point of a link: the acceleration (rows 0..2) and the link's angular one (3..5) that velocity alone gives.
  Eigen::Vector<double, 6> bias(std::size_t link, const Vec3& point_in_link_m) const noexcept;
  Eigen::Vector3d com_bias() const noexcept;

 private:
  struct LinkBias {
    Eigen::Vector3d turning_rad_s, acceleration_m_s2, angular_rad_s2;
  };
  void find_biases() noexcept;

  const RobotModel* model_;
  Dynamics dynamics_;
  std::vector<LinkBias> biases_;
  std::vector<double> joint_velocity_rad_s_;
};

// The pose of the base in the task frame of a robot that stands on these points of these links.
struct StandPoint {
  std::size_t link = 0;
  Vec3 point_m{};
};
Pose base_over(const Kinematics& with_base_at_origin, const Quat& base, std::span<const StandPoint> feet) noexcept;

}  // namespace kadans

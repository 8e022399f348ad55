// Brings the whole robot's state from a snapshot into a rigid-body model, for the high level of control objects that
// compute with Dynamics. The base's orientation and angular velocity come from the estimator. Its position and
// acceleration are left out: the base counts as carried evenly.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "kadans/model/dynamics.h"
#include "kadans/signal/status.h"

namespace kadans {

class ModelState {
 public:
  explicit ModelState(const RobotModel& model);

  // Computes the dynamics of the snapshot, with the joints moved on at constant velocity by ahead_s. False, and nothing
  // changes, when a value in the snapshot is not finite.
  [[nodiscard]] bool update(const Snapshot& snapshot, double ahead_s = 0) noexcept;

  const Dynamics& dynamics() const noexcept { return dynamics_; }
  // What a joint's motor has to give of these efforts of all joints: its own, and of the joints that mimic it.
  double effort_of(const Eigen::VectorXd& efforts, std::size_t joint) const noexcept;
  // The same of a matrix of all joints by all joints: what moves `joint` when `moved` and the joints that mimic it
  // move.
  double entry_of(const Eigen::MatrixXd& matrix, std::size_t joint, std::size_t moved) const noexcept;
  double position_rad(std::size_t joint) const noexcept { return position_rad_[joint]; }

 private:
  struct Led {
    Eigen::Index joint;
    double multiplier;
  };

  std::vector<std::vector<Led>> led_;  // by joint: itself, and those that mimic it
  std::vector<double> position_rad_, velocity_rad_s_;
  Dynamics dynamics_;
};

}  // namespace kadans

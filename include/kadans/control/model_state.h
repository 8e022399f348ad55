// Brings the whole robot's state from a snapshot into a rigid-body model, for the high level of control objects that
// compute with Dynamics. The base's orientation and angular velocity come from the estimator. Its position and
// acceleration are left out: the base counts as carried evenly.
#pragma once

#include <vector>

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
  double position_rad(std::size_t joint) const noexcept { return position_rad_[joint]; }

 private:
  std::vector<double> position_rad_, velocity_rad_s_;
  Dynamics dynamics_;
};

}  // namespace kadans

// The whole robot's state as a rigid-body model wants it, from a snapshot: for the high level of control objects that
// compute with Dynamics. The base is taken as carried: where it points and how it turns come from the estimator, where
// it is and how it accelerates are left out.
#pragma once

#include <vector>

#include "kadans/model/dynamics.h"
#include "kadans/signal/status.h"

namespace kadans {

class ModelState {
 public:
  explicit ModelState(const RobotModel& model);

  // The dynamics become those of the snapshot, the joints moved on evenly by ahead_s. False, and they stay as they
  // were, when something in the snapshot is not finite.
  [[nodiscard]] bool update(const Snapshot& snapshot, double ahead_s = 0) noexcept;

  const Dynamics& dynamics() const noexcept { return dynamics_; }
  double position_rad(std::size_t joint) const noexcept { return position_rad_[joint]; }

 private:
  std::vector<double> position_rad_, velocity_rad_s_;
  Dynamics dynamics_;
};

}  // namespace kadans

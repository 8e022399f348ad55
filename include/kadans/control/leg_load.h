// The torques with which a leg bears: the ground pushes on its foot, its links weigh, and each joint holds against both
// (statics of an open chain; the transpose of the leg's Jacobian).
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "kadans/model/kinematics.h"
#include "kadans/model/robot_model.h"

namespace kadans {

class LegLoad {
 public:
  struct Bearing {
    std::size_t joint = 0;  // index in the model
    double effort_Nm = 0;
  };

  // The joints from the link up to the base. Keeps a reference to the model.
  LegLoad(const RobotModel& model, std::size_t foot);

  // force_N acts on the foot at point_m; both, and gravity, in the frame in which the kinematics have the base.
  void update(const Kinematics& kinematics, const Vec3& force_N, const Vec3& point_m) noexcept;

  std::span<const Bearing> bearings() const noexcept { return bearings_; }  // from the foot upwards

 private:
  const RobotModel* model_;
  std::vector<Bearing> bearings_;
};

}  // namespace kadans

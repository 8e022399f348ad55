// The joint torques of a leg that bears a load. They balance the force of the ground on the foot and the weight of the
// leg's links (statics of an open chain: the transpose of the leg's Jacobian).
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

  // The leg is the joints from the link `foot` up to the base. Keeps a reference to the model.
  LegLoad(const RobotModel& model, std::size_t foot);

  // force_N acts on the foot at point_m. Both are in the frame in which the kinematics have the base's pose; its z axis
  // points up.
  void update(const Kinematics& kinematics, const Vec3& force_N, const Vec3& point_m) noexcept;

  std::span<const Bearing> bearings() const noexcept { return bearings_; }  // from the foot upwards

 private:
  const RobotModel* model_;
  std::vector<Bearing> bearings_;
};

}  // namespace kadans

// A joint of an object that balances in effort mode: its torque fades in and out with the object's share, is bounded,
// and low-passed.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <algorithm>

#include "dcm_measure.h"
#include "kadans/control/joint_axis.h"

namespace kadans {

// The object's share of torque after dt_s: towards `wanted` while the robot stands, else 0.
inline double faded_share(double share, double wanted, bool stands, double dt_s) noexcept {
  const double most = standing_share_per_s * dt_s;
  return stands ? share + std::clamp(wanted - share, -most, most) : 0;
}

struct BalanceJoint {
  JointAxis axis;
  double wanted_Nm = 0, effort_Nm = 0;

  // bound_share: of the joint's torque limit. smooth_s: time constant of the low pass; 0: none.
  void give(double share, bool stands, double bound_share, double smooth_s, double dt_s,
            ActuationFrame& actuation) noexcept {
    const double most_Nm = bound_share * axis.effort_max_Nm;
    const double bounded_Nm = std::clamp(stands ? share * wanted_Nm : 0, -most_Nm, most_Nm);
    const double smooth = smooth_s > dt_s ? dt_s / smooth_s : 1;
    effort_Nm = stands ? effort_Nm + smooth * (bounded_Nm - effort_Nm) : 0;
    actuation.joints[axis.joint] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
};

}  // namespace kadans

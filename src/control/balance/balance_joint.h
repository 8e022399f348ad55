// A joint of an object that balances in effort mode: its torque fades in and out with the object's share, is bounded,
// and low-passed. And what these objects have in common.
//
// One owner, the control thread; only declare_efforts() allocates or throws.
#pragma once

#include <algorithm>
#include <vector>

#include "dcm_measure.h"
#include "kadans/control/joint_axis.h"
#include "leg_parts.h"

namespace kadans {

// The object's share of torque after dt_s: towards `wanted` while the robot stands, else 0.
inline double faded_share(double share, double wanted, bool stands, double dt_s) noexcept {
  const double most = standing_share_per_s * dt_s;
  return stands ? share + std::clamp(wanted - share, -most, most) : 0;
}

struct BalanceJoint {
  JointAxis axis;
  JointPart in_leg{};  // for objects that ask for it
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

// An object that begins anew from no torque at each start, with a state of its own.
template <typename StateOf>
class Balancing : public ControlObject {
 public:
  using State = StateOf;

  void start(const ControlInput&) noexcept override {
    state_ = {};
    for (BalanceJoint& part : parts_) part.effort_Nm = 0;
  }
  void pass_state(StateBytes& bytes) noexcept override {
    for (BalanceJoint& part : parts_) bytes(part.effort_Nm);
    bytes(state_);
  }
  const State& state() const noexcept { return state_; }

 protected:
  void declare_efforts(Declaration& d) {
    for (BalanceJoint& part : parts_)
      d.signal({part.axis.name + ".effort_Nm", "Nm", "Torque asked for."}, &part.effort_Nm);
  }

  std::vector<BalanceJoint> parts_;
  State state_;
};

}  // namespace kadans

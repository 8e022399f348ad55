// The common part of the laws that lead a joint by one set-point: the joint, where the set-point is, and the motion in
// which a joint that is taken over comes to rest.
#pragma once

#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/control/takeover.h"

namespace kadans {

class PositionReference {
 public:
  static constexpr std::uint32_t channels = 1;

  double remaining_s() const noexcept { return reference_.remaining_s(); }
  bool setpoint_state(std::uint32_t which, SetpointState& state) const noexcept {
    return which == 0 && (state = reference_.state(), true);
  }
  void follow(std::uint32_t, const SetpointState& state) noexcept { reference_.follow(state); }
  void pass_state(StateBytes& bytes) noexcept { bytes(reference_); }

 protected:
  explicit PositionReference(const JointAxis& axis) : axis_(axis) {}
  // The reference continues with the joint's velocity and comes to rest.
  void take_over(const Takeover& takeover) noexcept {
    continue_motion(reference_, takeover.state.position_rad, takeover.state.velocity_rad_s, axis_);
  }

  JointAxis axis_;
  MinimumJerk reference_;
};

}  // namespace kadans

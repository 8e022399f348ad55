// The joints that no active control set holds. A spring and a damper from the configuration draw each of them back to
// where it was when it was let go. With stiffness 0 the joint is only damped, with both 0 it is off.
//
// One owner, the control thread; nothing here allocates after construction, locks or throws.
#pragma once

#include <array>
#include <vector>

#include "kadans/control/set_partition.h"

namespace kadans {

class UnheldJoints {
 public:
  explicit UnheldJoints(std::vector<UnheldLaw> laws) : laws_(std::move(laws)) {}

  // When the sets change. `held`: the joints that the sets hold from now on. A joint that was unheld before keeps the
  // position to which it is drawn.
  void let_go(JointMask held, const JointStates& joints) noexcept;
  void forget() noexcept { unheld_ = 0; }
  // Each tick.
  void step(const JointStates& joints, ActuationFrame& actuation) const noexcept;

 private:
  std::vector<UnheldLaw> laws_;  // by joint
  JointMask unheld_ = 0;
  std::array<double, max_joints> position_rad_{};
};

}  // namespace kadans

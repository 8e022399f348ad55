// The joints that no active control set holds: each is drawn back to where it was when it was let go, as stiff and
// damped as the configuration says. Without stiffness it damps, without both it is off.
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

  // When the sets change: which joints they hold from now on. What was unheld stays where it is drawn to.
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

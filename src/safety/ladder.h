// Where one joint, or the robot, stands on the degradation ladder, and why.
//
// Going down is immediate: each fault asks for a rung and the worst counts. A rung is left when its faults have been
// over for their exit time, so that a value that flickers about its limit makes one fault and not a thousand. A rung
// that is latched stays until it is cleared.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <array>

#include "fault_mask.h"
#include "reaction.h"

namespace kadans {

class Ladder {
 public:
  // `faults`: all faults of this tick. `rung` picks the joint's or the robot's part of a reaction. Returns the faults
  // that are new.
  FaultMask update(FaultMask faults, double dt_s, const Reactions& reactions, SafetyLevel Reaction::*rung) noexcept;
  // Goes down to `level` until cleared.
  void latch(SafetyLevel level) noexcept;
  void clear() noexcept { *this = {}; }

  SafetyLevel level() const noexcept { return level_; }
  // Nothing is wrong, was wrong lately or is latched: update(0) would change nothing.
  bool idle() const noexcept { return idle_; }

 private:
  void settle() noexcept;

  std::array<double, 5> left_s_{};       // by rung: until it may be left
  std::array<FaultMask, 5> reported_{};  // by rung: faults of the present episode
  FaultMask latched_faults_ = 0;
  SafetyLevel latched_ = SafetyLevel::normal;
  SafetyLevel level_ = SafetyLevel::normal;
  bool idle_ = true;
};

}  // namespace kadans

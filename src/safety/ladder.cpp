#include "ladder.h"

#include <algorithm>

namespace kadans {

FaultMask Ladder::update(FaultMask faults, double dt_s, const Reactions& reactions,
                         SafetyLevel Reaction::*rung) noexcept {
  for (double& left_s : left_s_) left_s = std::max(0.0, left_s - dt_s);
  FaultMask fresh = 0;
  for (FaultMask rest = faults; rest != 0; rest &= rest - 1) {
    const FaultCode code = first_of(rest);
    const Reaction& reaction = reactions[static_cast<std::size_t>(code)];
    const auto at = static_cast<std::size_t>(reaction.*rung);
    if (((reported_[at] | latched_faults_) & bit(code)) == 0) fresh |= bit(code);
    reported_[at] |= bit(code);
    left_s_[at] = std::max({left_s_[at], reaction.exit_s, dt_s, 1e-9});
    if (!reaction.latch) continue;
    latched_faults_ |= bit(code);
    latched_ = std::max(latched_, reaction.*rung);
  }
  settle();
  return fresh;
}

void Ladder::latch(SafetyLevel level) noexcept {
  latched_ = std::max(latched_, level);
  settle();
}

void Ladder::settle() noexcept {
  level_ = latched_;
  idle_ = latched_ == SafetyLevel::normal && latched_faults_ == 0;
  for (std::size_t at = 0; at < left_s_.size(); ++at) {
    if (left_s_[at] > 0) {
      level_ = std::max(level_, static_cast<SafetyLevel>(at));
      idle_ = false;
    } else {
      reported_[at] = 0;
    }
  }
}

}  // namespace kadans

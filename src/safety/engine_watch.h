// Finds faults of the runtime itself: no heartbeat of the behavior engine, and late ticks.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <cstdint>

#include "fault_mask.h"
#include "settings.h"

namespace kadans {

class EngineWatch {
 public:
  explicit EngineWatch(const SafetySettings& settings) noexcept
      : heartbeat_timeout_s_(settings.heartbeat_timeout_s), in_a_row_max_(settings.overruns_in_a_row_max) {}

  // `missed` ticks were skipped before this one. The count of late ticks in a row is kept until a tick comes in time.
  FaultMask look(double heartbeat_age_s, std::uint32_t missed) noexcept {
    using enum FaultCode;
    heartbeat_age_s_ = heartbeat_age_s;
    missed_ = missed;
    missed_ticks_ += missed;
    in_a_row_ = missed > 0 ? in_a_row_ + (in_a_row_ < in_a_row_max_ ? 1 : 0) : 0;
    return bit_if(!(heartbeat_age_s <= heartbeat_timeout_s_), heartbeat_lost) | bit_if(missed > 0, tick_overrun) |
           bit_if(in_a_row_ >= in_a_row_max_, overruns);
  }
  void describe(Fault& fault) const noexcept {
    if (fault.code == FaultCode::tick_overrun) fault.value = missed_;
    if (fault.code == FaultCode::heartbeat_lost) {
      fault.value = heartbeat_age_s_;
      fault.limit = heartbeat_timeout_s_;
    } else if (fault.code == FaultCode::overruns) {
      fault.value = in_a_row_;
      fault.limit = in_a_row_max_;
    }
  }
  void clear() noexcept { in_a_row_ = 0; }

  const std::uint32_t& missed_ticks() const noexcept { return missed_ticks_; }  // since the start

 private:
  double heartbeat_timeout_s_, heartbeat_age_s_ = 0;
  std::uint32_t in_a_row_max_, in_a_row_ = 0;
  std::uint32_t missed_ = 0, missed_ticks_ = 0;
};

}  // namespace kadans

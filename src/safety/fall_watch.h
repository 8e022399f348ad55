// Whether the robot stands, leans, falls or lies.
//
//   upright  Ends when roll, pitch or the rate of turning is beyond its limit for time_s: then the robot falls.
//   falling  Torque is reduced to a share, so that joints give way; impacts are recorded. Ends when the robot turned
//            slower than rest_rate for rest_s: then it lies.
//   fallen   Torque comes back, to get up, as fast as for a joint that damped (recover_s). Ends when the robot has been
//            well within the limits for rest_s. Here only the rate shows another fall, because a robot that gets up is
//            beyond the angles.
//
// The limits are those of small humanoids in the RoboCup leagues: 60 degrees of roll, 45 of pitch, 7 rad/s for 40 ms.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <cstdint>

#include "fault_mask.h"
#include "kadans/signal/status.h"
#include "settings.h"

namespace kadans {

class FallWatch {
 public:
  enum class Phase : std::uint8_t { upright, falling, fallen };

  explicit FallWatch(const SafetySettings& settings) noexcept
      : settings_(settings.fall), tilt_max_rad_(settings.tilt_max_rad), recover_s_(settings.recover_s) {}

  FaultMask look(const BaseStatus& base, const ImuSample& sample, double dt_s) noexcept;
  // Value and limit of a fault that look() has just found.
  void describe(const BaseStatus& base, Fault& fault) const noexcept;

  Phase phase() const noexcept { return phase_; }
  const std::uint32_t& phase_number() const noexcept { return phase_number_; }
  // Share of every torque: 1, except while falling and for a while afterwards.
  double share() const noexcept { return share_; }
  const double& impact_m_s2() const noexcept { return impact_m_s2_; }  // the largest of the last fall

 private:
  bool beyond(const BaseStatus& base, double rate_rad_s) const noexcept;
  void advance(const BaseStatus& base, double rate_rad_s, double dt_s) noexcept;

  FallSettings settings_;
  double tilt_max_rad_, recover_s_;
  Phase phase_ = Phase::upright;
  std::uint32_t phase_number_ = 0;
  double share_ = 1;
  double for_s_ = 0;  // how long the condition that ends the phase has lasted
  double impact_m_s2_ = 0;
};

}  // namespace kadans

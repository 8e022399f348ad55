// Cuts the torque that is asked of one joint: to the torque limit, derated when the motor is warm; so that it pushes no
// further into a soft stop and no further beyond the speed limit; to the power limit and the rate limit.
//
// The limits form an interval to which the torque is cut, so their order does not matter. The rate limit alone comes
// first, so that it delays none of the others.
//
// In position, velocity and impedance mode the drive makes the torque and keeps its own limit. Here the position asked
// is kept within the position limits and the speed asked within the speed limit; into a soft stop the speed fades as
// torque does. The torque added is cut as above.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <cmath>

#include "kadans/signal/frames.h"
#include "ladder.h"
#include "settings.h"

namespace kadans {

class JointLimiter {
 public:
  struct Input {
    const JointState& state;
    double derating;  // share of the torque limit that the winding allows
    double recovery;  // share of that, while a joint comes back from damp or off; no fault when it cuts
    double last_Nm;   // torque written in the last tick
    double change_s;  // the time in which the torque asked may have changed from last_Nm
  };

  JointLimiter() = default;
  JointLimiter(const SafetySettings& settings, const JointLimits& limits) noexcept;

  // `actuation` must be finite. Cuts it in place; returns the faults of the limits that cut it.
  FaultMask limit(const Input& input, JointActuation& actuation) noexcept {
    return actuation.mode == ActuationMode::effort && free(input, actuation.effort_Nm) ? 0 : cut(input, actuation);
  }
  // -damping * velocity, within torque and power; off when the velocity is not finite.
  JointActuation damp(const JointState& state) const noexcept;
  // Value and limit of a fault that limit() has just found.
  void describe(const Input& input, Fault& fault) const noexcept;

  // Whether none of the limits is near: the usual case, in a few comparisons.
  bool free(const Input& input, double asked_Nm) const noexcept;
  bool passive() const noexcept { return effort_max_Nm_ == 0; }

 private:
  struct Interval {
    double low, high;
  };
  FaultMask cut(const Input& input, JointActuation& actuation) noexcept;
  Interval soft_stops(double position_rad, Interval effort_Nm) const noexcept;
  Interval soft_speed(double velocity_rad_s, Interval effort_Nm) const noexcept;
  double power_bound_Nm(double velocity_rad_s, double effort_Nm) const noexcept;
  Interval speeds(double position_rad) const noexcept;
  FaultMask limit_set_point(double position_rad, JointActuation& actuation) noexcept;
  FaultMask who_cut(const Input& input, double asked_Nm) const noexcept;

  double effort_max_Nm_ = 0;  // 0: passive
  double rate_Nm_s_ = 0, power_max_W_ = 0;
  double velocity_max_rad_s_ = 0, velocity_fade_rad_s_ = 0;
  double lower_rad_ = 0, upper_rad_ = 0, zone_rad_ = 0, stiffness_Nm_per_rad_ = 0;
  double lowest_free_rad_ = 0, highest_free_rad_ = 0;  // between the soft stops
  double damping_Nms_per_rad_ = 0;
  // Of the last cut, for describe(); of a set-point what was asked and what was given.
  double asked_Nm_ = 0;
  FaultMask of_set_point_ = 0;
  double asked_rad_ = 0, given_rad_ = 0, asked_rad_s_ = 0, given_rad_s_ = 0;
};

// Here, because it runs for every joint in every tick.
inline bool JointLimiter::free(const Input& in, double asked_Nm) const noexcept {
  const double speed_rad_s = std::abs(in.state.velocity_rad_s);
  return std::abs(asked_Nm) <= effort_max_Nm_ * in.derating * in.recovery &&
         std::abs(asked_Nm - in.last_Nm) <= rate_Nm_s_ * in.change_s && speed_rad_s <= velocity_max_rad_s_ &&
         speed_rad_s * effort_max_Nm_ <= power_max_W_ && in.state.position_rad >= lowest_free_rad_ &&
         in.state.position_rad <= highest_free_rad_;
}

}  // namespace kadans

// Takes over a joint from what drove it before, without a jump in the drive's torque. The joint's measured state and
// the drive's last actuation give the state from which a control object's own law continues (inverse initialisation;
// Astrom and Hagglund, Advanced PID Control, ISA 2006, sec. 13.5).
//
// An object in effort mode continues with the torque from before. An object in position or velocity mode continues with
// the old set-point when the mode is the same. Otherwise it starts from the measured state, so that the drive's own
// gains give no torque yet, and adds the torque from before as feed-forward. This torque fades while the drive takes up
// the load.
#pragma once

#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/signal/frames.h"

namespace kadans {

struct Takeover {
  const JointState& state;     // measured in this tick
  const JointActuation& last;  // written in this tick
  double dt_s;
};

// The drive's torque before: the commanded one if the drive was in effort mode, 0 if it was off, else the measured one.
double effort_before_Nm(const Takeover& takeover) noexcept;

// The position mode's fields for the actuation that this tick computes. The drive uses it until the end of the next
// tick, two ticks after the measurement, so a moving reference is moved on to that time.
struct PositionStart {
  double position_rad, velocity_rad_s, effort_Nm;
};
PositionStart position_before(const Takeover& takeover) noexcept;

// The velocity mode's fields for the actuation that this tick computes.
struct VelocityStart {
  double velocity_rad_s, effort_Nm;
};
VelocityStart velocity_before(const Takeover& takeover) noexcept;

// How long a reference that is taken over in motion takes to come to rest.
inline constexpr double takeover_stop_s = 0.2;
// How long a motion that is cancelled takes to come to rest.
inline constexpr double cancel_time_s = 0.1;

// Lets the reference continue with the joint's position and velocity and come to rest within takeover_stop_s, before
// the joint's limit if possible. A joint beyond its limit is led back to the limit.
void continue_motion(MinimumJerk& reference, double position_rad, double velocity_rad_s,
                     const JointAxis& axis) noexcept;

// A torque that goes smoothly to 0 in fade_s.
class FadingEffort {
 public:
  void start(double effort_Nm) noexcept;
  double step(double dt_s) noexcept { return effort_Nm_.step(dt_s).value; }

  void pass_state(auto& bytes) noexcept { bytes(effort_Nm_); }

  static constexpr double fade_s = 0.2;

 private:
  MinimumJerk effort_Nm_;
};

}  // namespace kadans

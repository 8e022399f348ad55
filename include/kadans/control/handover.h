// Taking over a joint from whatever drove it before, without a jump in the drive's torque: what the joint does, what
// its drive was told last, and from these the state in which a control object's own law continues (inverse
// initialisation; Astrom and Hagglund, Advanced PID Control, ISA 2006, sec. 13.5).
//
// An object in effort mode continues with the torque that was there. One in position or velocity mode continues with
// the old set-point where the mode is the same; else it starts from the measured state, so that the drive's own gains
// give nothing yet, and adds the torque that was there as feed-forward, which then fades while the drive takes up the
// load.
#pragma once

#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/signal/frames.h"

namespace kadans {

struct Handover {
  const JointState& state;     // measured in this tick
  const JointActuation& last;  // written in this tick
  double dt_s;
};

// The torque of the drive in effort mode: what was asked for there, else what was measured.
double effort_before_Nm(const Handover& handover) noexcept;

// The position mode's fields as they continue in the actuation that this tick computes. A drive that follows a moving
// reference sees it at the end of the tick after this one: two ticks beyond the measurement.
struct PositionStart {
  double position_rad, velocity_rad_s, effort_Nm;
};
PositionStart position_before(const Handover& handover) noexcept;

// The velocity mode's fields, likewise.
struct VelocityStart {
  double velocity_rad_s, effort_Nm;
};
VelocityStart velocity_before(const Handover& handover) noexcept;

// How long a reference takes that is taken over in motion to come to rest.
inline constexpr double handover_stop_s = 0.2;
// And one whose motion is cancelled.
inline constexpr double cancel_time_s = 0.1;

// A reference that goes on where and as fast as the joint moves and comes to rest soon, before the joint's limit if
// that is possible. A joint beyond its limit is led back to it.
void continue_motion(MinimumJerk& reference, double position_rad, double velocity_rad_s,
                     const JointAxis& axis) noexcept;

// A torque that goes smoothly to 0 in fade_s.
class FadingEffort {
 public:
  void start(double effort_Nm) noexcept;
  double step(double dt_s) noexcept { return effort_Nm_.step(dt_s).position; }

  static constexpr double fade_s = 0.2;

 private:
  MinimumJerk effort_Nm_;
};

}  // namespace kadans

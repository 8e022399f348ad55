// The common part of the laws whose set-point is a velocity. The velocity approaches the set-point with limited
// acceleration and brakes before the joint's limits (VelocityRamp). The torque from before the start fades away.
#pragma once

#include "kadans/control/joint_axis.h"
#include "kadans/control/takeover.h"

namespace kadans {

// A velocity that goes to its set-point with limited acceleration and brakes before the end of the way.
//
// Let d be the way that is left, a the acceleration and dt the tick. The fastest velocity v from which the motion still
// stops in time satisfies v dt + v^2 / 2a = d. A velocity that follows this bound never needs more than a and comes to
// rest at the end, not beyond it. Braking before the end uses the full acceleration, whatever the duration of a
// set-point.
class VelocityRamp {
 public:
  // Starts with `velocity`; the set-point is 0, reached after duration_s.
  void start(double velocity, double duration_s) noexcept;
  // Reaches `goal` after duration_s, or as soon as the acceleration allows.
  void move(double goal, double duration_s) noexcept;
  // `below` and `above`: the way that is left in the negative and the positive direction, < 0 beyond the end.
  // acceleration_max > 0.
  double step(double dt_s, double acceleration_max, double below, double above) noexcept;

  double velocity() const noexcept { return velocity_; }
  double goal() const noexcept { return goal_; }
  bool limited() const noexcept { return limited_; }  // brakes for the end of the way
  // Time until the set-point is reached; 0 while limited.
  double remaining_s() const noexcept { return remaining_s_; }
  void pass_state(auto& bytes) noexcept { bytes(velocity_, goal_, asked_acceleration_, remaining_s_, limited_); }

 private:
  double velocity_ = 0;
  double goal_ = 0;
  double asked_acceleration_ = 0;  // 0: as fast as allowed
  double remaining_s_ = 0;
  bool limited_ = false;
};

class VelocityReference {
 public:
  static constexpr std::uint32_t channels = 1;

  void set_point(std::uint32_t, double value, double duration_s) noexcept { ramp_.move(value, duration_s); }
  void cancel(std::uint32_t) noexcept { ramp_.move(0, 0); }
  double remaining_s() const noexcept { return ramp_.remaining_s(); }
  void pass_state(StateBytes& bytes) noexcept { bytes(motion_, fading_, ramp_); }

 protected:
  struct Motion {
    double setpoint_rad_s = 0;
    double velocity_rad_s = 0;  // on the way to the set-point
    bool limited = false;       // a limit is in the way
  };

  explicit VelocityReference(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  // Continues with this velocity and torque; the set-point is 0.
  void take_over(double velocity_rad_s, double effort_Nm) noexcept;
  // Returns the velocity. below_rad and above_rad: the way that is left in the negative and the positive direction.
  double advance(double dt_s, double below_rad, double above_rad) noexcept;

  JointAxis axis_;
  Motion motion_;
  FadingEffort fading_;

 private:
  VelocityRamp ramp_;
  double acceleration_max_rad_s2_ = 20;  // 0.01..10000
};

}  // namespace kadans

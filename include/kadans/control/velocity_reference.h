// The common part of the laws whose set-point is a velocity. The velocity approaches the set-point with limited
// acceleration and brakes before the joint's limits (velocity_ramp.h). The torque from before the start fades away.
#pragma once

#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/velocity_ramp.h"

namespace kadans {

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

// What the laws have in common that take a velocity as set-point: the velocity is approached with limited acceleration
// and braked before the joint's limits (velocity_ramp.h), and the torque that was there at the start fades away.
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

 protected:
  struct Motion {
    double setpoint_rad_s = 0;
    double velocity_rad_s = 0;  // on the way to the set-point
    bool limited = false;       // by what is in the way
  };

  explicit VelocityReference(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  // The set-point is 0.
  void take_over(double velocity_rad_s, double effort_Nm) noexcept;
  // `below` and `above` are the ways left in either direction.
  double advance(double dt_s, double below_rad, double above_rad) noexcept;

  JointAxis axis_;
  Motion motion_;
  FadingEffort fading_;

 private:
  VelocityRamp ramp_;
  double acceleration_max_rad_s2_ = 20;  // 0.01..10000
};

}  // namespace kadans

// A velocity set-point on each joint, written in velocity mode, so that the drive's own loop follows it: type
// "joint_velocity". The set-point is approached with limited acceleration and braked before the joint's limits, as
// measured (velocity_ramp.h). A drive whose loop has no integral creeps under a load; ki adds what it lacks:
//
//   dI/dt = ki (v_ref - v), added to the drive's torque, within +-effort_max
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       with the drive's last set-point, or the measured velocity; the set-point is 0. The torque that was
//             there becomes the integral; with ki = 0 it fades.
#pragma once

#include <memory>

#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/velocity_ramp.h"

namespace kadans {

class VelocityLaw {
 public:
  struct Config {
    double acceleration_max_rad_s2 = 20;  // 0.01..10000
    double ki_Nm_per_rad = 0;             // 0..1000
    double effort_max_Nm = 0;
  };
  struct State {
    double setpoint_rad_s = 0;
    double reference_velocity_rad_s = 0;
    double error_rad_s = 0;  // reference minus measured
    double effort_Nm = 0;    // added to the drive's: the integral, or what is left of the torque taken over
    bool limited = false;    // by a position limit
    bool saturated = false;  // the integral
  };
  static constexpr std::uint32_t channels = 1;

  explicit VelocityLaw(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept { return ramp_.remaining_s(); }

 private:
  double added_effort_Nm(double dt_s) noexcept;

  JointAxis axis_;
  Config config_;
  State state_;
  VelocityRamp ramp_;
  FadingEffort fading_;
};

std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup);

}  // namespace kadans

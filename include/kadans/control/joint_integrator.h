// Integrates a velocity set-point to a position on each joint and writes it in position mode, the velocity as
// feed-forward: type "joint_integrator". For robots that are steered by rates: a camera head behind a joystick, a gaze
// controller that computes joint velocities at 20 Hz.
//
//   dv/dt within +-acceleration_max towards the set-point,  dq_ref/dt = v
//
// The motion brakes before the joint's limits (velocity_ramp.h) and stops at them; one that is taken over too fast for
// that brakes as hard as it may. With lead_max_rad above 0 it also brakes before it is so far ahead of the measured
// joint: a blocked joint does not wind the position up.
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       from the drive's last set-point, or from the measured state with a fading torque; the set-point is 0.
#pragma once

#include <memory>

#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/velocity_ramp.h"

namespace kadans {

class IntegratorLaw {
 public:
  struct Config {
    double acceleration_max_rad_s2 = 20;  // 0.01..10000
    double lead_max_rad = 0;              // 0..10; 0: no bound
  };
  struct State {
    double setpoint_rad_s = 0;
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double effort_Nm = 0;  // what is left of the torque taken over
    bool limited = false;  // by a position limit or by lead_max
  };
  static constexpr std::uint32_t channels = 1;

  explicit IntegratorLaw(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept { return ramp_.remaining_s(); }

 private:
  JointAxis axis_;
  Config config_;
  State state_;
  VelocityRamp ramp_;
  FadingEffort fading_;
  double lowest_rad_ = 0, highest_rad_ = 0;  // the joint's range, and where it was at the start
};

std::unique_ptr<ControlObject> make_joint_integrator(const ObjectSetup& setup);

}  // namespace kadans

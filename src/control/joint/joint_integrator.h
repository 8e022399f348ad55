// Integrates a velocity set-point to a position on each joint and writes it in position mode, with the velocity as
// feed-forward: type "joint_integrator". For robots that are commanded by rates (Whitney 1969, Resolved Motion Rate
// Control, IEEE Trans. Man-Machine Systems 10(2)), for example a camera head with a joystick, or a gaze controller that
// computes joint velocities at 20 Hz.
//
//   dv/dt within +-acceleration_max towards the set-point,  dq_ref/dt = v
//
// The motion brakes before the joint's limits (velocity_ramp.h) and stops at them. A motion that is too fast for that
// when it is taken over brakes with acceleration_max. With lead_max_rad > 0 the reference also stays within that
// distance ahead of the measured joint, so that a blocked joint does not wind the position up.
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       the reference continues from the drive's last set-point in position mode, else from the measured state
//             while the torque from before fades; the set-point is 0.
#pragma once

#include <memory>

#include "kadans/control/velocity_reference.h"

namespace kadans {

class IntegratorLaw : public VelocityReference {
 public:
  struct Config {
    double lead_max_rad = 0;  // 0..10; 0: no bound
  };
  struct State {
    double reference_rad = 0;
    double effort_Nm = 0;  // the rest of the torque taken over
  };

  explicit IntegratorLaw(const JointAxis& axis) : VelocityReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    VelocityReference::pass_state(bytes);
    bytes(state_, lowest_rad_, highest_rad_);
  }

 private:
  Config config_;
  State state_;
  double lowest_rad_ = 0, highest_rad_ = 0;  // the joint's range, widened to where it was at the start
};

std::unique_ptr<ControlObject> make_joint_integrator(const ObjectSetup& setup);

}  // namespace kadans

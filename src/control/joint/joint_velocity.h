// A velocity set-point on each joint, written in velocity mode: the drive's own velocity loop follows it. Type
// "joint_velocity". The velocity approaches the set-point with limited acceleration and brakes before the joint's
// limits, by the measured position (velocity_ramp.h). A drive without an integral in its loop has a velocity error
// under load; ki removes it (the PI speed loop of Leonhard, Control of Electrical Drives, 3rd ed., ch. 15):
//
//   dI/dt = ki (v_ref - v), added to the drive's torque, within +-effort_max
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       the velocity continues from the drive's last set-point in velocity mode, else from the measured velocity;
//             the set-point is 0. The torque from before becomes the integral; with ki = 0 it fades.
#pragma once

#include <memory>

#include "kadans/control/velocity_reference.h"

namespace kadans {

class VelocityLaw : public VelocityReference {
 public:
  struct Config {
    double ki_Nm_per_rad = 0;  // 0..1000
    double effort_max_Nm = 0;
  };
  struct State {
    double error_rad_s = 0;  // reference minus measured
    double effort_Nm = 0;    // added to the drive's: the integral, or the rest of the torque taken over
    bool saturated = false;  // effort_Nm is at its bound
  };

  explicit VelocityLaw(const JointAxis& axis) : VelocityReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    VelocityReference::pass_state(bytes);
    bytes(state_);
  }

 private:
  double added_effort_Nm(double dt_s) noexcept;

  Config config_;
  State state_;
};

std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup);

}  // namespace kadans

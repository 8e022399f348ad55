// A velocity set-point on each joint, written in velocity mode, so that the drive's own loop follows it: type
// "joint_velocity". The set-point is approached with limited acceleration and braked before the joint's limits, as
// measured (velocity_ramp.h). A drive whose loop has no integral creeps under a load; ki adds what it lacks (the PI
// speed loop of Leonhard, Control of Electrical Drives, 3rd ed., ch. 15):
//
//   dI/dt = ki (v_ref - v), added to the drive's torque, within +-effort_max
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       with the drive's last set-point, or the measured velocity; the set-point is 0. The torque that was
//             there becomes the integral; with ki = 0 it fades.
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
    double effort_Nm = 0;    // added to the drive's: the integral, or what is left of the torque taken over
    bool saturated = false;  // the integral
  };

  explicit VelocityLaw(const JointAxis& axis) : VelocityReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;

 private:
  double added_effort_Nm(double dt_s) noexcept;

  Config config_;
  State state_;
};

std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup);

}  // namespace kadans

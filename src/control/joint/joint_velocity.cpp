// A velocity set-point on each joint, written in velocity mode: the drive's own velocity loop follows it. Type
// "joint_velocity". The velocity approaches the set-point with limited acceleration and brakes before the joint's
// limits, by the measured position (velocity_reference.h). A drive without an integral in its loop has a velocity error
// under load; ki removes it (the PI speed loop of Leonhard, Control of Electrical Drives, 3rd ed., ch. 15):
//
//   dI/dt = ki (v_ref - v), added to the drive's torque, within +-effort_max
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       the velocity continues from the drive's last set-point in velocity mode, else from the measured velocity;
//             the set-point is 0. The torque from before becomes the integral; with ki = 0 it fades.
#include <algorithm>
#include <memory>

#include "kadans/control/jointwise.h"
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
  void start(const Takeover& takeover) noexcept;
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

void VelocityLaw::declare(AxisTables& tables) {
  VelocityReference::declare(tables);
  const double most = axis_.effort_max_Nm;
  tables.tunable("ki_Nm_per_rad", "Nm/rad", 0, 1000, 0, &config_.ki_Nm_per_rad,
                 "Growth of the torque added per velocity error.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &config_.effort_max_Nm, "Bound of the torque added.");
  tables.signal("error_rad_s", "rad/s", "Reference's velocity minus the joint's.", &state_.error_rad_s);
  tables.signal("effort_Nm", "Nm", "Torque added to the drive's own.", &state_.effort_Nm);
  tables.signal("saturated", "", "Whether the torque added was limited.", &state_.saturated);
}

void VelocityLaw::start(const Takeover& takeover) noexcept {
  const VelocityStart before = velocity_before(takeover);
  state_ = {.effort_Nm = before.effort_Nm};
  take_over(before.velocity_rad_s, before.effort_Nm);
}

double VelocityLaw::added_effort_Nm(double dt_s) noexcept {
  const double fading_Nm = fading_.step(dt_s);
  const double unlimited_Nm =
      config_.ki_Nm_per_rad > 0 ? state_.effort_Nm + config_.ki_Nm_per_rad * state_.error_rad_s * dt_s : fading_Nm;
  const double limited_Nm = std::clamp(unlimited_Nm, -config_.effort_max_Nm, config_.effort_max_Nm);
  state_.saturated = limited_Nm != unlimited_Nm;
  return limited_Nm;
}

JointActuation VelocityLaw::step(const JointState& joint, double dt_s) noexcept {
  const double velocity_rad_s =
      advance(dt_s, joint.position_rad - axis_.lower_rad, axis_.upper_rad - joint.position_rad);
  state_.error_rad_s = velocity_rad_s - joint.velocity_rad_s;
  state_.effort_Nm = added_effort_Nm(dt_s);
  return {.effort_Nm = state_.effort_Nm, .velocity_rad_s = velocity_rad_s, .mode = ActuationMode::velocity};
}

std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<VelocityLaw>>(setup);
}

}  // namespace kadans

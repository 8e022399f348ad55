// Integrates a velocity set-point to a position on each joint and writes it in position mode, with the velocity as
// feed-forward: type "joint_integrator". For robots that are commanded by rates (Whitney 1969, Resolved Motion Rate
// Control, IEEE Trans. Man-Machine Systems 10(2)), for example a camera head with a joystick, or a gaze controller that
// computes joint velocities at 20 Hz.
//
//   dv/dt within +-acceleration_max towards the set-point,  dq_ref/dt = v
//
// The motion brakes before the joint's limits (VelocityRamp) and stops at them. A motion that is too fast for that
// when it is taken over brakes with acceleration_max. With lead_max_rad > 0 the reference also stays within that
// distance ahead of the measured joint, so that a blocked joint does not wind the position up.
//
// Set-points  <joint>.velocity_rad_s, reached in the time given or as soon as acceleration_max allows.
// Start       the reference continues from the drive's last set-point in position mode, else from the measured state
//             while the torque from before fades; the set-point is 0.
#include <algorithm>
#include <memory>

#include "kadans/control/jointwise.h"
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
  void start(const Takeover& takeover) noexcept;
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

void IntegratorLaw::declare(AxisTables& tables) {
  VelocityReference::declare(tables);
  tables.tunable("lead_max_rad", "rad", 0, 10, 0, &config_.lead_max_rad,
                 "How far the reference may be ahead of the joint; 0 is no bound.");
  tables.signal("reference_rad", "rad", "The velocity's integral: where the joint shall be.", &state_.reference_rad);
  tables.signal("effort_Nm", "Nm", "What is left of the torque taken over.", &state_.effort_Nm);
}

void IntegratorLaw::start(const Takeover& takeover) noexcept {
  const PositionStart before = position_before(takeover);
  state_ = {.reference_rad = before.position_rad, .effort_Nm = before.effort_Nm};
  lowest_rad_ = std::min(axis_.lower_rad, before.position_rad);
  highest_rad_ = std::max(axis_.upper_rad, before.position_rad);
  take_over(before.velocity_rad_s, before.effort_Nm);
}

JointActuation IntegratorLaw::step(const JointState& joint, double dt_s) noexcept {
  State& s = state_;
  double below_rad = s.reference_rad - axis_.lower_rad, above_rad = axis_.upper_rad - s.reference_rad;
  if (config_.lead_max_rad > 0) {
    const double lead_rad = s.reference_rad - joint.position_rad;
    below_rad = std::min(below_rad, config_.lead_max_rad + lead_rad);
    above_rad = std::min(above_rad, config_.lead_max_rad - lead_rad);
  }
  const double velocity_rad_s = advance(dt_s, below_rad, above_rad);
  s.reference_rad = std::clamp(s.reference_rad + dt_s * velocity_rad_s, lowest_rad_, highest_rad_);
  s.effort_Nm = fading_.step(dt_s);
  return {.effort_Nm = s.effort_Nm,
          .position_rad = s.reference_rad,
          .velocity_rad_s = velocity_rad_s,
          .mode = ActuationMode::position};
}

std::unique_ptr<ControlObject> make_joint_integrator(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<IntegratorLaw>>(setup);
}

}  // namespace kadans

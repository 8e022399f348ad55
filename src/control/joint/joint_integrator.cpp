#include "joint_integrator.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {

void IntegratorLaw::declare(AxisTables& tables) {
  VelocityReference::declare(tables);
  tables.tunable("lead_max_rad", "rad", 0, 10, 0, &config_.lead_max_rad,
                 "How far the reference may be ahead of the joint; 0 is no bound.");
  tables.signal("reference_rad", "rad", "The velocity's integral: where the joint shall be.", &state_.reference_rad);
  tables.signal("effort_Nm", "Nm", "What is left of the torque taken over.", &state_.effort_Nm);
}

void IntegratorLaw::start(const Handover& handover) noexcept {
  const PositionStart before = position_before(handover);
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

#include "kadans/control/joint_integrator.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {

void IntegratorLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double fastest = axis_.velocity_max_rad_s;
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.01, 10000, 20, &c.acceleration_max_rad_s2,
                 "Bound of the velocity's change.");
  tables.tunable("lead_max_rad", "rad", 0, 10, 0, &c.lead_max_rad,
                 "How far the reference may be ahead of the joint; 0 is no bound.");
  tables.setpoint("velocity_rad_s", "rad/s", -fastest, fastest, "How fast the joint shall move.", 0);
  tables.signal("setpoint_rad_s", "rad/s", "Velocity asked for.", &s.setpoint_rad_s);
  tables.signal("reference_rad", "rad", "The velocity's integral: where the joint shall be.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("effort_Nm", "Nm", "What is left of the torque taken over.", &s.effort_Nm);
  tables.signal("limited", "", "Whether a limit is in the way.", &s.limited);
}

void IntegratorLaw::start(const Handover& handover) noexcept {
  const PositionStart before = position_before(handover);
  state_ = {};
  state_.reference_rad = before.position_rad;
  lowest_rad_ = std::min(axis_.lower_rad, before.position_rad);
  highest_rad_ = std::max(axis_.upper_rad, before.position_rad);
  ramp_.start(before.velocity_rad_s, handover_stop_s);
  fading_.start(before.effort_Nm);
}

JointActuation IntegratorLaw::step(const JointState& joint, double dt_s) noexcept {
  State& s = state_;
  double below_rad = s.reference_rad - axis_.lower_rad, above_rad = axis_.upper_rad - s.reference_rad;
  if (config_.lead_max_rad > 0) {
    const double lead_rad = s.reference_rad - joint.position_rad;
    below_rad = std::min(below_rad, config_.lead_max_rad + lead_rad);
    above_rad = std::min(above_rad, config_.lead_max_rad - lead_rad);
  }
  const double velocity_rad_s = ramp_.step(dt_s, config_.acceleration_max_rad_s2, below_rad, above_rad);
  s.setpoint_rad_s = ramp_.goal();
  s.reference_velocity_rad_s = velocity_rad_s;
  s.reference_rad = std::clamp(s.reference_rad + dt_s * velocity_rad_s, lowest_rad_, highest_rad_);
  s.limited = ramp_.limited();
  s.effort_Nm = fading_.step(dt_s);
  return {.effort_Nm = s.effort_Nm,
          .position_rad = s.reference_rad,
          .velocity_rad_s = velocity_rad_s,
          .mode = ActuationMode::position};
}

void IntegratorLaw::set_point(std::uint32_t, double value, double duration_s) noexcept {
  ramp_.move(value, duration_s);
}

void IntegratorLaw::cancel(std::uint32_t) noexcept { ramp_.move(0, 0); }

std::unique_ptr<ControlObject> make_joint_integrator(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<IntegratorLaw>>(setup);
}

}  // namespace kadans

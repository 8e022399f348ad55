#include "joint_cascade.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {

void CascadeLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double most = axis_.effort_max_Nm, fastest = axis_.velocity_max_rad_s;
  tables.tunable("kp_per_s", "1/s", 0, 200, 0, &c.kp_per_s, "Velocity per position error.");
  tables.tunable("kv_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.kv_Nms_per_rad, "Torque per velocity error.");
  tables.tunable("ki_Nm_per_rad", "Nm/rad", 0, 50000, 0, &c.ki_Nm_per_rad, "Growth of torque per velocity error.");
  tables.tunable("inertia_kg_m2", "kg m2", 0, 10, 0, &c.inertia_kg_m2, "Torque per acceleration of the reference.");
  tables.tunable("velocity_weight", "", 0, 1, 1, &c.velocity_weight, "Share of the reference's velocity fed forward.");
  tables.tunable("feedforward_Nm", "Nm", -most, most, 0, &c.feedforward_Nm, "Torque added always.");
  tables.tunable("integral_max_Nm", "Nm", 0, most, most, &c.integral_max_Nm, "Bound of the integral.");
  tables.tunable("velocity_max_rad_s", "rad/s", 0, fastest, fastest, &c.velocity_max_rad_s,
                 "Bound of the velocity that the position loop asks for.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  tables.position_setpoint(0);
  tables.signal("reference_rad", "rad", "Set-point of the position.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("error_rad", "rad", "Set-point minus position.", &s.error_rad);
  tables.signal("velocity_command_rad_s", "rad/s", "What the position loop asks for.", &s.velocity_command_rad_s);
  tables.signal("integral_Nm", "Nm", "Torque of the integral.", &s.integral_Nm);
  tables.signal("effort_Nm", "Nm", "Torque computed.", &s.effort_Nm);
  tables.signal("velocity_limited", "", "Whether the velocity asked for was limited.", &s.velocity_limited);
  tables.signal("saturated", "", "Whether the torque was limited.", &s.saturated);
}

double CascadeLaw::velocity_command(const MinimumJerk::State& reference, double position_rad) noexcept {
  State& s = state_;
  s.reference_rad = reference.position;
  s.reference_velocity_rad_s = reference.velocity;
  s.error_rad = reference.position - position_rad;
  const double wanted_rad_s = config_.velocity_weight * reference.velocity + config_.kp_per_s * s.error_rad;
  s.velocity_command_rad_s = std::clamp(wanted_rad_s, -config_.velocity_max_rad_s, config_.velocity_max_rad_s);
  s.velocity_limited = s.velocity_command_rad_s != wanted_rad_s;
  return s.velocity_command_rad_s;
}

void CascadeLaw::start(const Handover& handover) noexcept {
  const JointState& joint = handover.state;
  state_ = {};
  take_over(handover);
  state_.effort_Nm = effort_before_Nm(handover);
  const double velocity_error_rad_s = velocity_command(reference_.state(), joint.position_rad) - joint.velocity_rad_s;
  const double wanted_Nm = state_.effort_Nm - config_.feedforward_Nm - config_.kv_Nms_per_rad * velocity_error_rad_s;
  state_.integral_Nm = std::clamp(wanted_Nm, -config_.integral_max_Nm, config_.integral_max_Nm);
}

JointActuation CascadeLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  const MinimumJerk::State& reference = reference_.step(dt_s);
  const double velocity_error_rad_s = velocity_command(reference, joint.position_rad) - joint.velocity_rad_s;

  const double unlimited_Nm = c.feedforward_Nm + c.inertia_kg_m2 * reference.acceleration +
                              c.kv_Nms_per_rad * velocity_error_rad_s + s.integral_Nm;
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;

  const double growth_Nm = c.ki_Nm_per_rad * velocity_error_rad_s * dt_s;
  const bool winds_up = s.saturated && growth_Nm * unlimited_Nm > 0;
  if (!winds_up) s.integral_Nm = std::clamp(s.integral_Nm + growth_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  return {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
}

std::unique_ptr<ControlObject> make_joint_cascade(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<CascadeLaw>>(setup);
}

}  // namespace kadans

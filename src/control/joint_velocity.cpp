#include "kadans/control/joint_velocity.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {

void VelocityLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double fastest = axis_.velocity_max_rad_s, most = axis_.effort_max_Nm;
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.01, 10000, 20, &c.acceleration_max_rad_s2,
                 "Bound of the velocity's change.");
  tables.tunable("ki_Nm_per_rad", "Nm/rad", 0, 1000, 0, &c.ki_Nm_per_rad,
                 "Growth of the torque added per velocity error.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque added.");
  tables.setpoint("velocity_rad_s", "rad/s", -fastest, fastest, "How fast the joint shall move.", 0);
  tables.signal("setpoint_rad_s", "rad/s", "Velocity asked for.", &s.setpoint_rad_s);
  tables.signal("reference_velocity_rad_s", "rad/s", "Velocity that the drive is told.", &s.reference_velocity_rad_s);
  tables.signal("error_rad_s", "rad/s", "That minus the joint's.", &s.error_rad_s);
  tables.signal("effort_Nm", "Nm", "Torque added to the drive's own.", &s.effort_Nm);
  tables.signal("limited", "", "Whether a position limit is in the way.", &s.limited);
  tables.signal("saturated", "", "Whether the torque added was limited.", &s.saturated);
}

void VelocityLaw::start(const Handover& handover) noexcept {
  const VelocityStart before = velocity_before(handover);
  state_ = {};
  state_.effort_Nm = before.effort_Nm;
  ramp_.start(before.velocity_rad_s, handover_stop_s);
  fading_.start(before.effort_Nm);
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
  State& s = state_;
  s.reference_velocity_rad_s = ramp_.step(dt_s, config_.acceleration_max_rad_s2, joint.position_rad - axis_.lower_rad,
                                          axis_.upper_rad - joint.position_rad);
  s.setpoint_rad_s = ramp_.goal();
  s.error_rad_s = s.reference_velocity_rad_s - joint.velocity_rad_s;
  s.limited = ramp_.limited();
  s.effort_Nm = added_effort_Nm(dt_s);
  return {.effort_Nm = s.effort_Nm, .velocity_rad_s = s.reference_velocity_rad_s, .mode = ActuationMode::velocity};
}

void VelocityLaw::set_point(std::uint32_t, double value, double duration_s) noexcept { ramp_.move(value, duration_s); }

void VelocityLaw::cancel(std::uint32_t) noexcept { ramp_.move(0, 0); }

std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<VelocityLaw>>(setup);
}

}  // namespace kadans

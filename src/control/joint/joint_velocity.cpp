#include "joint_velocity.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {

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

void VelocityLaw::start(const Handover& handover) noexcept {
  const VelocityStart before = velocity_before(handover);
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

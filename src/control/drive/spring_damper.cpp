#include "kadans/control/spring_damper.h"

#include <algorithm>

namespace kadans {

void SpringDamper::declare(AxisTables& tables, const Names& names) {
  const double most = tables.axis().effort_max_Nm;
  tables.tunable(names.stiffness, "Nm/rad", 0, 5000, 0, &config_.stiffness_Nm_per_rad, "Torque per position error.");
  tables.tunable(names.damping, "Nm s/rad", 0, 500, 0, &config_.damping_Nms_per_rad, "Torque per velocity error.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &config_.effort_max_Nm, "Bound of the torque.");
  tables.signal("reference_rad", "rad", "Where the joint is led.", &state_.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "How fast it is led.", &state_.reference_velocity_rad_s);
  tables.signal(names.error, "rad", "Reference minus position.", &state_.error_rad);
  tables.signal("effort_Nm", "Nm", "Torque computed.", &state_.effort_Nm);
  tables.signal("saturated", "", "Whether the torque was limited.", &state_.saturated);
}

void SpringDamper::start(double effort_Nm) noexcept { state_ = {.effort_Nm = effort_Nm}; }

JointActuation SpringDamper::step(double reference_rad, double reference_velocity_rad_s, double effort_Nm,
                                  const JointState& joint) noexcept {
  const Config& c = config_;
  State& s = state_;
  s.reference_rad = reference_rad;
  s.reference_velocity_rad_s = reference_velocity_rad_s;
  s.error_rad = reference_rad - joint.position_rad;
  const double unlimited_Nm = effort_Nm + c.stiffness_Nm_per_rad * s.error_rad +
                              c.damping_Nms_per_rad * (reference_velocity_rad_s - joint.velocity_rad_s);
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;
  if (!in_drive_) return {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
  return {.effort_Nm = std::clamp(effort_Nm, -c.effort_max_Nm, c.effort_max_Nm),
          .position_rad = reference_rad,
          .velocity_rad_s = reference_velocity_rad_s,
          .stiffness_Nm_per_rad = c.stiffness_Nm_per_rad,
          .damping_Nms_per_rad = c.damping_Nms_per_rad,
          .mode = ActuationMode::impedance};
}

}  // namespace kadans

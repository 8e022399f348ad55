#include "kadans/control/joint_impedance.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {
namespace {

constexpr double cancel_time_s = 0.1;

}  // namespace

void ImpedanceLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double most = axis_.effort_max_Nm;
  tables.tunable("stiffness_Nm_per_rad", "Nm/rad", 0, 5000, 0, &c.stiffness_Nm_per_rad, "Of the spring.");
  tables.tunable("damping_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.damping_Nms_per_rad, "Of the damper.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  tables.position_setpoint(0);
  tables.setpoint("effort_Nm", "Nm", -most, most, "Torque beside spring and damper.", 1);
  tables.signal("reference_rad", "rad", "Where the spring's other end is.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("reference_effort_Nm", "Nm", "Torque beside spring and damper.", &s.reference_effort_Nm);
  tables.signal("deflection_rad", "rad", "Reference minus position.", &s.deflection_rad);
  tables.signal("effort_Nm", "Nm", "Torque computed.", &s.effort_Nm);
  tables.signal("saturated", "", "Whether the torque was limited.", &s.saturated);
}

void ImpedanceLaw::start(const Handover& handover) noexcept {
  const double effort_Nm = effort_before_Nm(handover);
  state_ = {};
  state_.effort_Nm = effort_Nm;
  continue_motion(reference_, handover.state.position_rad, handover.state.velocity_rad_s, axis_);
  effort_.reset(effort_Nm);
}

JointActuation ImpedanceLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  const MinimumJerk::State& reference = reference_.step(dt_s);
  s.reference_rad = reference.position;
  s.reference_velocity_rad_s = reference.velocity;
  s.reference_effort_Nm = effort_.step(dt_s).position;
  s.deflection_rad = reference.position - joint.position_rad;
  const double unlimited_Nm = s.reference_effort_Nm + c.stiffness_Nm_per_rad * s.deflection_rad +
                              c.damping_Nms_per_rad * (reference.velocity - joint.velocity_rad_s);
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;
  return {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
}

void ImpedanceLaw::set_point(std::uint32_t which, double value, double duration_s) noexcept {
  (which == 0 ? reference_ : effort_).move(value, duration_s);
}

void ImpedanceLaw::cancel(std::uint32_t which) noexcept { (which == 0 ? reference_ : effort_).stop(cancel_time_s); }

double ImpedanceLaw::remaining_s() const noexcept { return std::max(reference_.remaining_s(), effort_.remaining_s()); }

std::unique_ptr<ControlObject> make_joint_impedance(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<ImpedanceLaw>>(setup);
}

}  // namespace kadans

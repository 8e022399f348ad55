#include "joint_impedance.h"

#include <string>

#include "kadans/control/jointwise.h"

namespace kadans {

void ImpedanceLaw::declare(AxisTables& tables) {
  const double most = axis_.effort_max_Nm;
  law_.declare(tables, {"stiffness_Nm_per_rad", "damping_Nms_per_rad", "deflection_rad"});
  tables.position_setpoint(0);
  tables.setpoint("effort_Nm", "Nm", -most, most, "Torque beside spring and damper.", 1);
  tables.signal("reference_effort_Nm", "Nm", "Torque beside spring and damper.", &effort_.value);
}

void ImpedanceLaw::start(const Handover& handover) noexcept {
  const double effort_Nm = effort_before_Nm(handover);
  take_over(handover);
  law_.start(effort_Nm);
  effort_ = {.value = effort_Nm};
}

JointActuation ImpedanceLaw::step(const JointState& joint, double dt_s) noexcept {
  const MinimumJerk::State& reference = reference_.step(dt_s);
  return law_.step(reference.position, reference.velocity, effort_.value, joint);
}

bool ImpedanceLaw::setpoint_state(std::uint32_t which, SetpointState& state) const noexcept {
  return which == 0 ? PositionReference::setpoint_state(which, state) : (state = effort_, true);
}

void ImpedanceLaw::follow(std::uint32_t which, const SetpointState& state) noexcept {
  if (which == 0) return PositionReference::follow(which, state);
  effort_ = state;
}

namespace {

class JointImpedance final : public Jointwise<ImpedanceLaw> {
 public:
  explicit JointImpedance(const ObjectSetup& setup) : Jointwise(setup) {
    const std::string* loop = setup.options.find("loop");
    if (loop == nullptr || *loop == "here") return;
    if (*loop != "drive") throw OptionError("loop", "loop is '" + *loop + "', must be here or drive");
    for (std::size_t i = 0; i < size(); ++i) law(i).compute_in_drive(true);
  }
};

}  // namespace

std::unique_ptr<ControlObject> make_joint_impedance(const ObjectSetup& setup) {
  return std::make_unique<JointImpedance>(setup);
}

}  // namespace kadans

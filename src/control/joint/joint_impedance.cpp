#include "joint_impedance.h"

#include <algorithm>
#include <string>

#include "kadans/control/jointwise.h"

namespace kadans {

void ImpedanceLaw::declare(AxisTables& tables) {
  const double most = axis_.effort_max_Nm;
  law_.declare(tables, {"stiffness_Nm_per_rad", "damping_Nms_per_rad", "deflection_rad"});
  tables.position_setpoint(0);
  tables.setpoint("effort_Nm", "Nm", -most, most, "Torque beside spring and damper.", 1);
  tables.signal("reference_effort_Nm", "Nm", "Torque beside spring and damper.", &effort_.state().position);
}

void ImpedanceLaw::start(const Handover& handover) noexcept {
  const double effort_Nm = effort_before_Nm(handover);
  take_over(handover);
  law_.start(effort_Nm);
  effort_.reset(effort_Nm);
}

JointActuation ImpedanceLaw::step(const JointState& joint, double dt_s) noexcept {
  const MinimumJerk::State& reference = reference_.step(dt_s);
  return law_.step(reference.position, reference.velocity, effort_.step(dt_s).position, joint);
}

void ImpedanceLaw::set_point(std::uint32_t which, double value, double duration_s) noexcept {
  (which == 0 ? reference_ : effort_).move(value, duration_s);
}

void ImpedanceLaw::cancel(std::uint32_t which) noexcept { (which == 0 ? reference_ : effort_).stop(cancel_time_s); }

double ImpedanceLaw::remaining_s() const noexcept { return std::max(reference_.remaining_s(), effort_.remaining_s()); }

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

// A spring and a damper between each joint and its reference, plus a torque that is a set-point: type "joint_impedance"
// (Hogan 1985, Impedance Control, J. Dyn. Sys. Meas. Control 107; part I, without shaping the inertia).
//
//   u = limit(effort_ref + K (q_ref - q) + D (v_ref - v), +-effort_max)
//
// There is no integral: a lasting push keeps the joint deflected. effort_ref carries the load.
//
// Option      loop: "here" (the default), or "drive": the drive computes the law (impedance mode).
// Set-points  <joint>.position_rad and <joint>.effort_Nm, each reached along a minimum-jerk curve in the time given.
// Start       the reference continues with the joint's velocity and comes to rest. effort_ref is the torque from
//             before, until it is set.
#include <memory>
#include <string>

#include "kadans/control/jointwise.h"
#include "kadans/control/position_reference.h"
#include "kadans/control/spring_damper.h"

namespace kadans {

class ImpedanceLaw : public PositionReference {
 public:
  static constexpr std::uint32_t channels = 2;  // the reference's position; the torque

  explicit ImpedanceLaw(const JointAxis& axis) : PositionReference(axis) {}
  void declare(AxisTables& tables);
  void compute_in_drive(bool in_drive) noexcept { law_.compute_in_drive(in_drive); }
  void start(const Takeover& takeover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  bool setpoint_state(std::uint32_t which, SetpointState& state) const noexcept;
  void follow(std::uint32_t which, const SetpointState& state) noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    PositionReference::pass_state(bytes);
    bytes(law_, effort_);
  }

 private:
  SpringDamper law_;
  SetpointState effort_;
};

void ImpedanceLaw::declare(AxisTables& tables) {
  const double most = axis_.effort_max_Nm;
  law_.declare(tables, {"stiffness_Nm_per_rad", "damping_Nms_per_rad", "deflection_rad"});
  tables.position_setpoint(0);
  tables.setpoint("effort_Nm", "Nm", -most, most, "Torque beside spring and damper.", 1);
  tables.signal("reference_effort_Nm", "Nm", "Torque beside spring and damper.", &effort_.value);
}

void ImpedanceLaw::start(const Takeover& takeover) noexcept {
  const double effort_Nm = effort_before_Nm(takeover);
  take_over(takeover);
  law_.start(effort_Nm);
  effort_ = {.value = effort_Nm};
}

JointActuation ImpedanceLaw::step(const JointState& joint, double dt_s) noexcept {
  const SetpointState& reference = reference_.step(dt_s);
  return law_.step(reference.value, reference.velocity, effort_.value, joint);
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

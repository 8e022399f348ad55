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
#pragma once

#include <memory>

#include "kadans/control/position_reference.h"
#include "kadans/control/spring_damper.h"

namespace kadans {

class ImpedanceLaw : public PositionReference {
 public:
  static constexpr std::uint32_t channels = 2;  // the reference's position; the torque

  explicit ImpedanceLaw(const JointAxis& axis) : PositionReference(axis) {}
  void declare(AxisTables& tables);
  void compute_in_drive(bool in_drive) noexcept { law_.compute_in_drive(in_drive); }
  void start(const Handover& handover) noexcept;
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

std::unique_ptr<ControlObject> make_joint_impedance(const ObjectSetup& setup);

}  // namespace kadans

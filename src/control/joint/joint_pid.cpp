// PID on each joint, in effort mode, with a set-point that moves smoothly: type "joint_pid". The law is pid.h.
//
// Set-points  <joint>.position_rad (within the joint's limits), reached by a minimum-jerk motion in the time given.
// Parameters  a Pid::Config per joint: <joint>.kp_Nm_per_rad and so on.
// Signals     a Pid::State per joint: <joint>.reference_rad and so on.
// Start       the reference continues with the joint's velocity and comes to rest; the integral takes over the torque
//             from before.
#include <memory>

#include "kadans/control/jointwise.h"
#include "kadans/control/pid.h"
#include "kadans/control/position_reference.h"

namespace kadans {

class PidLaw : public PositionReference {
 public:
  explicit PidLaw(const JointAxis& axis) : PositionReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Takeover& takeover) noexcept;
  JointActuation step(const JointState& joint, double dt_s) noexcept {
    const SetpointState& reference = reference_.step(dt_s);
    return {.effort_Nm = pid_.step(reference.value, reference.velocity, joint.position_rad, joint.velocity_rad_s, dt_s),
            .mode = ActuationMode::effort};
  }
  void rehearse(const JointState& joint, double dt_s) const noexcept {
    MinimumJerk reference = reference_;
    Pid pid = pid_;
    const SetpointState& at = reference.step(dt_s);
    (void)pid.step(at.value, at.velocity, joint.position_rad, joint.velocity_rad_s, dt_s);
  }
  void pass_state(StateBytes& bytes) noexcept {
    PositionReference::pass_state(bytes);
    bytes(pid_);
  }

 private:
  Pid pid_;
};

using JointPid = Jointwise<PidLaw>;

void PidLaw::declare(AxisTables& tables) {
  tables.pid(pid_);
  tables.position_setpoint(0);
}

void PidLaw::start(const Takeover& takeover) noexcept {
  take_over(takeover);
  pid_.start(takeover.state.position_rad, takeover.state.velocity_rad_s, effort_before_Nm(takeover),
             reference_.state().velocity);
}

std::unique_ptr<ControlObject> make_joint_pid(const ObjectSetup& setup) { return std::make_unique<JointPid>(setup); }

}  // namespace kadans

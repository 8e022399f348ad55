#include "joint_pid.h"

namespace kadans {

void PidLaw::declare(AxisTables& tables) {
  tables.pid(pid_);
  tables.position_setpoint(0);
}

void PidLaw::start(const Handover& handover) noexcept {
  take_over(handover);
  pid_.start(handover.state.position_rad, handover.state.velocity_rad_s, effort_before_Nm(handover),
             reference_.state().velocity);
}

std::unique_ptr<ControlObject> make_joint_pid(const ObjectSetup& setup) { return std::make_unique<JointPid>(setup); }

}  // namespace kadans

#include "kadans/control/unheld_joints.h"

namespace kadans {

void UnheldJoints::let_go(JointMask held, const JointStates& joints) noexcept {
  JointMask now = 0;
  for (std::size_t joint = 0; joint < laws_.size(); ++joint) {
    const UnheldLaw& law = laws_[joint];
    const bool acts = law.stiffness_Nm_per_rad > 0 || law.damping_Nms_per_rad > 0;
    if (acts && (held & joint_bit(joint)) == 0) now |= joint_bit(joint);
  }
  each_bit(now & ~unheld_, [&](std::uint32_t joint) { position_rad_[joint] = joints.joints[joint].position_rad; });
  unheld_ = now;
}

void UnheldJoints::step(const JointStates& joints, ActuationFrame& actuation) const noexcept {
  each_bit(unheld_, [&](std::uint32_t joint) {
    const UnheldLaw& law = laws_[joint];
    const JointState& state = joints.joints[joint];
    const double effort_Nm = law.stiffness_Nm_per_rad * (position_rad_[joint] - state.position_rad) -
                             law.damping_Nms_per_rad * state.velocity_rad_s;
    actuation.joints[joint] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  });
}

}  // namespace kadans

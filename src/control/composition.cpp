#include "kadans/control/composition.h"

namespace kadans {
namespace {

bool blend(double weight, const JointActuation& proposal, JointActuation& actuation) noexcept {
  if (proposal.mode != actuation.mode) {
    if (!(weight >= 0.5)) return false;
    actuation = proposal;
    return true;
  }
  const auto between = [weight](double a, double b) { return a + weight * (b - a); };
  actuation.effort_Nm = between(actuation.effort_Nm, proposal.effort_Nm);
  actuation.position_rad = between(actuation.position_rad, proposal.position_rad);
  actuation.velocity_rad_s = between(actuation.velocity_rad_s, proposal.velocity_rad_s);
  actuation.stiffness_Nm_per_rad = between(actuation.stiffness_Nm_per_rad, proposal.stiffness_Nm_per_rad);
  actuation.damping_Nms_per_rad = between(actuation.damping_Nms_per_rad, proposal.damping_Nms_per_rad);
  return weight > 0;
}

bool sum(const JointActuation& proposal, JointActuation& actuation) noexcept {
  if (proposal.mode == ActuationMode::off) return false;
  if (actuation.mode == ActuationMode::off) {
    actuation = proposal;
  } else {
    actuation.effort_Nm += proposal.effort_Nm;
  }
  return true;
}

}  // namespace

bool compose(Composition composition, double weight, const JointActuation& proposal,
             JointActuation& actuation) noexcept {
  switch (composition) {
    case Composition::set:
      break;
    case Composition::sum:
      return sum(proposal, actuation);
    case Composition::blend:
      return blend(weight, proposal, actuation);
    case Composition::priority:
      if (proposal.mode == ActuationMode::off) return false;
      break;
  }
  actuation = proposal;
  return true;
}

}  // namespace kadans

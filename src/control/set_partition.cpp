#include "kadans/control/set_partition.h"

#include <stdexcept>
#include <string>

namespace kadans {

SetPartition::SetPartition(const Catalog& catalog) : sets_(catalog.sets.size()) {
  if (sets_.size() > max_control_sets) {
    throw std::invalid_argument(std::to_string(sets_.size()) + " control sets, at most " +
                                std::to_string(max_control_sets) + " are possible");
  }
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    for (const std::uint32_t object : catalog.sets[i].objects) {
      sets_[i].objects |= ObjectMask{1} << object;
      for (const std::size_t joint : catalog.objects.at(object).joints) sets_[i].joints |= joint_bit(joint);
    }
  }
  for (std::uint32_t a = 0; a < sets_.size(); ++a) {
    for (std::uint32_t b = 0; b < sets_.size(); ++b) {
      const bool share = (sets_[a].joints & sets_[b].joints) != 0 || (sets_[a].objects & sets_[b].objects) != 0;
      if (a != b && share) sets_[a].touched |= set_bit(b);
    }
  }
}

bool SetPartition::clash(SetMask a, SetMask b) const noexcept {
  bool any = false;
  each_bit(a, [&](std::uint32_t set) { any = any || (sets_[set].touched & b) != 0; });
  return any;
}

JointMask SetPartition::joints(SetMask sets) const noexcept {
  JointMask all = 0;
  each_bit(sets, [&](std::uint32_t set) { all |= sets_[set].joints; });
  return all;
}

ObjectMask SetPartition::objects(SetMask sets) const noexcept {
  ObjectMask all = 0;
  each_bit(sets, [&](std::uint32_t set) { all |= sets_[set].objects; });
  return all;
}

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

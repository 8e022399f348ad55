#include "joint_row.h"

#include <algorithm>
#include <cmath>

namespace kadans::bullet {

JointRow::JointRow(Tree& tree, int dof, const JointLaw& law, btScalar impulse, RowMemory& memory)
    : tree_(&tree),
      path_(tree.shape().path(dof)),
      y_(memory.take(static_cast<std::size_t>(path_.length))),
      lower_(law.lower),
      upper_(law.upper) {
  tree.response(dof, y_);
  for (int p = 0; p < path_.length; ++p) response_ += y_[p] * y_[p];
  if (!(response_ > 0)) return;
  gain_ = law.stiff ? 1 / response_ : law.slope / (1 + law.slope * response_);
  leak_ = law.stiff ? 0 : 1 / (1 + law.slope * response_);
  offset_ = (law.stiff ? law.wanted_rad_s * gain_ : law.at_rest * leak_) - gain_ * tree.velocity(dof);
  apply(std::clamp(impulse, lower_, upper_));
}

void JointRow::apply(btScalar change) {
  impulse_ += change;
  btScalar* const z = tree_->z();
  for (int p = 0; p < path_.length; ++p) z[path_.dofs[p]] += y_[p] * change;
}

btScalar JointRow::iterate() {
  const btScalar* const z = tree_->z();
  btScalar velocity = 0;
  for (int p = 0; p < path_.length; ++p) velocity += y_[p] * z[path_.dofs[p]];
  const btScalar wanted = impulse_ + offset_ - gain_ * velocity - leak_ * impulse_;
  const btScalar change = std::clamp(wanted, lower_, upper_) - impulse_;
  if (change != 0) apply(change);
  return std::abs(change) * response_;
}

}  // namespace kadans::bullet

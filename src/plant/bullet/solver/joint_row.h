// A law of one joint that is not linear, or one of a free body's axes: a row of one number in the solver's iteration.
//
// The law is that of joint_rows.h: p = clamp(a - b v, lower, upper), or v = wanted within the limits of p when it is
// stiff. With y of the degree of freedom (tree_factor.h) and d = y . y, an iteration sets p so that the law is
// fulfilled while all other impulses stay: p += (a - b v - p) / (1 + b d), or p += (wanted - v) / d, clamped.
#pragma once

#include "joint_law.h"
#include "row_memory.h"
#include "tree.h"

namespace kadans::bullet {

class JointRow {
 public:
  // Starts from `impulse`. The memory lives as long as the row.
  JointRow(Tree& tree, int dof, const JointLaw& law, btScalar impulse, RowMemory& memory);

  // Returns how much it changed its velocity.
  btScalar iterate();
  btScalar impulse() const { return impulse_; }

 private:
  void apply(btScalar change);

  Tree* tree_;
  Path path_;
  btScalar* y_;
  btScalar lower_, upper_;
  btScalar offset_ = 0, gain_ = 0, leak_ = 0, response_ = 0;  // p += offset - gain v - leak p
  btScalar impulse_ = 0;
};

}  // namespace kadans::bullet

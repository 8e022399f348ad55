// The joint-space inertia M of a tree and its sparse factor.
//
// M has an entry only where one degree of freedom carries the other, and M = L^T D L with L as sparse as M itself:
// going from the leaves to the base, eliminating row k touches only rows of degrees of freedom on k's path (RBDA 6.5
// and table 6.3). For each degree of freedom its row along its path is stored (tree_shape.h), diagonal last. The path
// of the p-th degree of freedom on k's path is the beginning of k's own path, so all inner loops run over dense arrays.
//
// Solving is done in halves. With G = D^-1/2 L^-T, M^-1 = G^T G, so
//     y = G J^T  gives  J M^-1 J^T = y . y,
// and y has entries only on the path of the link that J belongs to: a row of a contact needs a dozen numbers, not the
// whole robot.
// Impulses p of many rows add up in z = sum of y p, and one second half, G^T z, turns them into joint velocities.
#pragma once

#include <array>
#include <vector>

#include "tree_shape.h"

namespace kadans::bullet {

class TreeFactor {
 public:
  explicit TreeFactor(const TreeShape& shape);  // keeps a reference

  // To be filled before factorise(): entries of the row of a degree of freedom along its path, diagonal last.
  btScalar* row(int dof) { return &entries_[static_cast<std::size_t>(shape_->row_start(dof))]; }
  void factorise();

  // y along the path of `dof` <- G y.
  void first_half(int dof, btScalar* y) const;
  void first_half(int dof, std::array<btScalar, 4>* y) const;  // four at once
  // The same for a vector of all degrees of freedom.
  void first_half(btScalar* y) const;
  // x <- G^T x, all degrees of freedom.
  void second_half(btScalar* x) const;

 private:
  const btScalar* row(int dof) const { return &entries_[static_cast<std::size_t>(shape_->row_start(dof))]; }
  btScalar scale(int dof) const { return scales_[static_cast<std::size_t>(dof)]; }

  const TreeShape* shape_;
  std::vector<btScalar> entries_;  // of M, then of L
  std::vector<btScalar> scales_;   // D^-1/2
};

}  // namespace kadans::bullet

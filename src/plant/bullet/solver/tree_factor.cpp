#include "tree_factor.h"

#include <cmath>

namespace kadans::bullet {

TreeFactor::TreeFactor(const TreeShape& shape)
    : shape_(&shape),
      entries_(static_cast<std::size_t>(shape.entry_count())),
      scales_(static_cast<std::size_t>(shape.dof_count())) {}

void TreeFactor::factorise() {
  for (int k = shape_->dof_count() - 1; k >= 0; --k) {
    const Path path = shape_->path(k);
    btScalar* const own = row(k);
    const btScalar diagonal = own[path.length - 1], inverse = 1 / diagonal;
    scales_[static_cast<std::size_t>(k)] = 1 / std::sqrt(diagonal);
    for (int p = path.length - 2; p >= 0; --p) {
      const btScalar share = own[p] * inverse;
      btScalar* const carrier = row(path.dofs[p]);
      for (int q = 0; q <= p; ++q) carrier[q] -= share * own[q];
      own[p] = share;
    }
  }
}

void TreeFactor::first_half(int dof, btScalar* y) const {
  const Path path = shape_->path(dof);
  for (int p = path.length - 1; p >= 0; --p) {
    const btScalar* const factor = row(path.dofs[p]);
    const btScalar value = y[p];
    for (int q = 0; q < p; ++q) y[q] -= value * factor[q];
    y[p] = value * scale(path.dofs[p]);
  }
}

void TreeFactor::first_half(int dof, std::array<btScalar, 4>* y) const {
  const Path path = shape_->path(dof);
  for (int p = path.length - 1; p >= 0; --p) {
    const btScalar* const factor = row(path.dofs[p]);
    const std::array<btScalar, 4> value = y[p];
    for (int q = 0; q < p; ++q) {
      for (std::size_t c = 0; c < 4; ++c) y[q][c] -= value[c] * factor[q];
    }
    for (std::size_t c = 0; c < 4; ++c) y[p][c] = value[c] * scale(path.dofs[p]);
  }
}

void TreeFactor::first_half(btScalar* y) const {
  for (int k = shape_->dof_count() - 1; k >= 0; --k) {
    const Path path = shape_->path(k);
    const btScalar* const factor = row(k);
    const btScalar value = y[k];
    for (int p = 0; p < path.length - 1; ++p) y[path.dofs[p]] -= value * factor[p];
    y[k] = value * scale(k);
  }
}

void TreeFactor::second_half(btScalar* x) const {
  for (int k = 0; k < shape_->dof_count(); ++k) {
    const Path path = shape_->path(k);
    const btScalar* const factor = row(k);
    btScalar value = x[k] * scale(k);
    for (int p = 0; p < path.length - 1; ++p) value -= factor[p] * x[path.dofs[p]];
    x[k] = value;
  }
}

}  // namespace kadans::bullet

#include "tree_shape.h"

namespace kadans::bullet {

bool TreeShape::fits(const btMultiBody& body) {
  for (int i = 0; i < body.getNumLinks(); ++i) {
    if (body.getLink(i).m_dofCount > 1) return false;
  }
  return true;
}

TreeShape::TreeShape(const btMultiBody& body) {
  for (int dof = 0; dof < base_dofs; ++dof) add_row(dof - 1);
  links_.emplace_back();
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const Link parent = at(body.getParent(i));
    Link link{body.getParent(i), -1, parent.last_dof};
    if (body.getLink(i).m_dofCount == 1) {
      link.dof = link.last_dof = dof_count();
      add_row(parent.last_dof);
    }
    links_.push_back(link);
  }
}

void TreeShape::add_row(int parent_dof) {
  const int start = entry_count(), length = parent_dof < 0 ? 0 : path(parent_dof).length;
  for (int i = 0; i < length; ++i) {
    dofs_.push_back(dofs_[static_cast<std::size_t>(row_start(parent_dof) + i)]);
  }
  dofs_.push_back(dof_count());
  rows_.push_back({start, length + 1});
}

}  // namespace kadans::bullet

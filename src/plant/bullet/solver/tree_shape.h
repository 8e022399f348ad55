// Which degrees of freedom move which links: the constant structure of a multibody's joint-space inertia.
//
// The base has degrees of freedom 0..5: its angular velocity, then the velocity of its centre of mass, in world axes.
// Each joint of one degree of freedom follows, in the order of the links; a fixed joint has none. The path of a degree
// of freedom is the list of all degrees of freedom that carry it, from the base to itself; the path of a link is that
// of its joint. A path begins with the base's six. Each beginning of a path is a path itself: that of its last degree
// of freedom. A row of the joint-space inertia has entries only along its path, so it can be stored as a dense array
// (tree_factor.h).
#pragma once

#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>

namespace kadans::bullet {

inline constexpr int base_dofs = 6;

struct Path {
  const int* dofs = nullptr;
  int length = 0;
};

class TreeShape {
 public:
  // False for a body with a joint of several degrees of freedom.
  static bool fits(const btMultiBody& body);
  explicit TreeShape(const btMultiBody& body);

  int dof_count() const { return static_cast<int>(rows_.size()); }
  int link_count() const { return static_cast<int>(links_.size()) - 1; }
  // -1 is the base.
  int parent(int link) const { return at(link).parent; }
  int dof(int link) const { return at(link).dof; }  // its joint's, or -1 when it is fixed
  Path link_path(int link) const { return path(at(link).last_dof); }
  Path path(int dof) const {
    const Row& row = rows_[static_cast<std::size_t>(dof)];
    return {&dofs_[static_cast<std::size_t>(row.start)], row.length};
  }
  // Where the row of a degree of freedom begins when all are stored one after the other.
  int row_start(int dof) const { return rows_[static_cast<std::size_t>(dof)].start; }
  int entry_count() const { return static_cast<int>(dofs_.size()); }

 private:
  struct Link {
    int parent = -1, dof = -1, last_dof = base_dofs - 1;
  };
  struct Row {
    int start = 0, length = 0;
  };

  const Link& at(int link) const { return links_[static_cast<std::size_t>(link + 1)]; }
  void add_row(int parent_dof);

  std::vector<Link> links_;  // the base first
  std::vector<Row> rows_;
  std::vector<int> dofs_;  // all paths
};

}  // namespace kadans::bullet

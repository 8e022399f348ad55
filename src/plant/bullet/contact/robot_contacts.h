// Several robots in one world: contacts between what stands in different contact worlds.
//
// Each robot has a contact world of its own; the objects stand in that of the first. So a robot that touches nothing of
// another's moves bit for bit as if it were alone: it has its own order of contacts, its own number of iterations. Here
// the links of different robots meet, and further robots meet the objects. touch_points.h finds where. Contact worlds
// whose moving bodies touch are solved together, all others each for itself.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contact_world.h"

namespace kadans::bullet {

class RobotContacts {
 public:
  // Keeps references. Everything must have been added to the worlds, which all use the tree solver.
  explicit RobotContacts(std::vector<ContactWorld*> worlds);

  // One step of all the worlds.
  void step(double dt_s);

 private:
  // Two shapes that are near each other. The manifold keeps its impulses from step to step.
  struct Meeting {
    std::array<const btCollisionObject*, 2> colliders{};
    std::array<int, 2> parts{};
    std::unique_ptr<btPersistentManifold> manifold;
  };

  void meet(std::size_t first, std::size_t second);
  void touch(std::size_t first, std::size_t second, const btCollisionObject& a, const btCollisionObject& b);
  Meeting take(const btCollisionObject& a, const btCollisionObject& b, const std::array<int, 2>& parts);
  void count(const Meeting& meeting, std::size_t first, std::size_t second);
  void solve();

  std::vector<ContactWorld*> worlds_;
  std::vector<std::vector<const btCollisionObject*>> colliders_;  // of each world, without the ground
  std::vector<Meeting> now_, last_, spare_;
  std::vector<std::size_t> island_;  // of each world: the first world that it is solved with
  std::vector<TreeSolver::Group> groups_;
};

}  // namespace kadans::bullet

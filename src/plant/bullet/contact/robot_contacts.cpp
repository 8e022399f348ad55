#include "robot_contacts.h"

#include <algorithm>
#include <utility>

#include <LinearMath/btAabbUtil2.h>

#include "part_contact.h"

namespace kadans::bullet {
namespace {

constexpr std::size_t meetings_per_world = 64;  // room from the start, so that hardly any step allocates

bool moves(const btCollisionObject& collider) { return btMultiBodyLinkCollider::upcast(&collider) != nullptr; }

// By the boxes that the broadphases of both worlds keep around them.
bool near(const btCollisionObject& a, const btCollisionObject& b) {
  const btBroadphaseProxy &box_a = *a.getBroadphaseHandle(), &box_b = *b.getBroadphaseHandle();
  return TestAabbAgainstAabb2(box_a.m_aabbMin, box_a.m_aabbMax, box_b.m_aabbMin, box_b.m_aabbMax);
}

}  // namespace

RobotContacts::RobotContacts(std::vector<ContactWorld*> worlds)
    : worlds_(std::move(worlds)), colliders_(worlds_.size()), island_(worlds_.size()) {
  const std::size_t room = meetings_per_world * worlds_.size();
  for (std::size_t i = 0; i < worlds_.size(); ++i) {
    colliders_[i] = worlds_[i]->colliders();
    worlds_[i]->reserve_crossing(room);
  }
  groups_.reserve(worlds_.size());
  for (auto* list : {&now_, &last_, &spare_}) list->reserve(room);
  for (std::size_t i = 0; i < room; ++i) spare_.push_back({.manifold = std::make_unique<btPersistentManifold>()});
}

void RobotContacts::step(double dt_s) {
  for (ContactWorld* world : worlds_) world->begin_step(dt_s);
  std::swap(now_, last_);
  for (std::size_t i = 0; i < worlds_.size(); ++i) island_[i] = i;
  for (std::size_t second = 1; second < worlds_.size(); ++second) {
    for (std::size_t first = 0; first < second; ++first) meet(first, second);
  }
  for (Meeting& over : last_) {
    if (over.manifold != nullptr) spare_.push_back(std::move(over));
  }
  last_.clear();
  solve();
  for (ContactWorld* world : worlds_) world->end_step(dt_s);
}

void RobotContacts::meet(std::size_t first, std::size_t second) {
  for (const btCollisionObject* a : colliders_[first]) {
    for (const btCollisionObject* b : colliders_[second]) {
      if (near(*a, *b)) touch(first, second, *a, *b);
    }
  }
}

// A link comes before an object, as in object_contact.cpp.
void RobotContacts::touch(std::size_t first, std::size_t second, const btCollisionObject& a,
                          const btCollisionObject& b) {
  if (in_world(a)) return touch(second, first, b, a);
  for (int i = 0; i < parts_of(a).getNumChildShapes(); ++i) {
    for (int j = 0; j < parts_of(b).getNumChildShapes(); ++j) {
      Meeting meeting = take(a, b, {i, j});
      renew_contact(*meeting.manifold, i, j);
      if (meeting.manifold->getNumContacts() == 0) {
        spare_.push_back(std::move(meeting));
      } else {
        count(meeting, first, second);
        now_.push_back(std::move(meeting));
      }
    }
  }
}

RobotContacts::Meeting RobotContacts::take(const btCollisionObject& a, const btCollisionObject& b,
                                           const std::array<int, 2>& parts) {
  for (Meeting& meeting : last_) {
    if (meeting.manifold == nullptr || meeting.colliders[0] != &a || meeting.colliders[1] != &b) continue;
    if (meeting.parts == parts) return std::move(meeting);
  }
  if (spare_.empty()) spare_.push_back({.manifold = std::make_unique<btPersistentManifold>()});
  Meeting fresh = std::move(spare_.back());
  spare_.pop_back();
  fresh.colliders = {&a, &b};
  fresh.parts = parts;
  fresh.manifold->clearManifold();
  fresh.manifold->setBodies(&a, &b);
  return fresh;
}

// Both worlds read the contact, one solves it. What stands still couples nothing.
void RobotContacts::count(const Meeting& meeting, std::size_t first, std::size_t second) {
  worlds_[first]->cross(*meeting.manifold, true);
  worlds_[second]->cross(*meeting.manifold, false);
  if (!moves(*meeting.colliders[1])) return;
  const auto [low, high] = std::minmax(island_[first], island_[second]);
  std::replace(island_.begin(), island_.end(), std::size_t{high}, std::size_t{low});
}

void RobotContacts::solve() {
  for (std::size_t island = 0; island < worlds_.size(); ++island) {
    groups_.clear();
    for (std::size_t i = island; i < worlds_.size(); ++i) {
      if (island_[i] == island) groups_.push_back(worlds_[i]->group());
    }
    if (!groups_.empty()) TreeSolver::solve_together(groups_);
  }
}

}  // namespace kadans::bullet

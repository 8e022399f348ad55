#include "room.h"

#include <vector>

#include "plant/bullet/body.h"
#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

struct Bounds {
  btVector3 lower, upper;
};

// Of each convex part, less what may lie in another without harm.
void add_boxes(const btCollisionObject& collider, std::vector<Bounds>& boxes) {
  const auto& shape = static_cast<const btCompoundShape&>(*collider.getCollisionShape());
  const btVector3 harmless(start_depth_max_m / 2, start_depth_max_m / 2, start_depth_max_m / 2);
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    Bounds box;
    shape.getChildShape(i)->getAabb(collider.getWorldTransform() * shape.getChildTransform(i), box.lower, box.upper);
    boxes.push_back({box.lower + harmless, box.upper - harmless});
  }
}

bool overlap(const Bounds& a, const Bounds& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.upper[i] <= b.lower[i] || b.upper[i] <= a.lower[i]) return false;
  }
  return true;
}

}  // namespace

bool is_crowded(const btMultiBody& body, std::span<ContactWorld* const> worlds) {
  std::vector<Bounds> own, others;
  for (const ContactWorld* world : worlds) {
    for (const btCollisionObject* collider : world->colliders()) {
      const btMultiBodyLinkCollider* link = btMultiBodyLinkCollider::upcast(collider);
      if (link != nullptr) add_boxes(*link, link->m_multiBody == &body ? own : others);
    }
  }
  for (const Bounds& a : own) {
    for (const Bounds& b : others) {
      if (overlap(a, b)) return true;
    }
  }
  return false;
}

std::string no_room(const std::string& hand) {
  return hand + ": other robots and objects leave no room within " + printed("%g", room_max_m) + " m of this place";
}

}  // namespace kadans::bullet

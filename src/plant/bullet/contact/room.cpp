#include "room.h"

#include <algorithm>
#include <vector>

#include <LinearMath/btAabbUtil2.h>

#include "object_contact.h"
#include "part_contact.h"
#include "plant/bullet/body.h"
#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

struct Bounds {
  btVector3 lower, upper;
};

// Of each convex part, less what may lie in another without harm.
void add_boxes(const btCollisionObject& collider, std::vector<Bounds>& boxes) {
  const btCompoundShape& shape = parts_of(collider);
  const btVector3 harmless(start_depth_max_m / 2, start_depth_max_m / 2, start_depth_max_m / 2);
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    Bounds box;
    shape.getChildShape(i)->getAabb(collider.getWorldTransform() * shape.getChildTransform(i), box.lower, box.upper);
    boxes.push_back({box.lower + harmless, box.upper - harmless});
  }
}

bool overlap(const Bounds& a, const Bounds& b) { return TestAabbAgainstAabb2(a.lower, a.upper, b.lower, b.upper); }

bool boxes_meet(const btCollisionObject& a, const btCollisionObject& b) {
  Bounds bounds_a, bounds_b;
  a.getCollisionShape()->getAabb(a.getWorldTransform(), bounds_a.lower, bounds_a.upper);
  b.getCollisionShape()->getAabb(b.getWorldTransform(), bounds_b.lower, bounds_b.upper);
  return overlap(bounds_a, bounds_b);
}

double depth_between_m(const btCollisionObject& a, const btCollisionObject& b) {
  if (!boxes_meet(a, b)) return 0;
  double depth_m = 0;
  for (int i = 0; i < parts_of(a).getNumChildShapes(); ++i) {
    for (int j = 0; j < parts_of(b).getNumChildShapes(); ++j) {
      for (const TouchPoint& point : touch_points(a, i, b, j)) depth_m = std::max(depth_m, -point.distance_m);
    }
  }
  return depth_m;
}

}  // namespace

bool is_crowded(const btMultiBody& body, std::span<ContactWorld* const> worlds) {
  std::vector<Bounds> own, others;
  std::vector<const btCollisionObject*> links, fixed;
  for (const ContactWorld* world : worlds) {
    for (const btCollisionObject* collider : world->colliders()) {
      const btMultiBodyLinkCollider* link = btMultiBodyLinkCollider::upcast(collider);
      if (link == nullptr) {
        fixed.push_back(collider);
      } else if (link->m_multiBody == &body) {
        links.push_back(collider);
        add_boxes(*collider, own);
      } else {
        add_boxes(*collider, others);
      }
    }
  }
  for (const Bounds& a : own) {
    for (const Bounds& b : others) {
      if (overlap(a, b)) return true;
    }
  }
  for (const btCollisionObject* link : links) {
    for (const btCollisionObject* thing : fixed) {
      if (depth_between_m(*link, *thing) > start_depth_max_m) return true;
    }
  }
  return false;
}

Deepest deepest_in_others(std::span<ContactWorld* const> worlds) {
  std::vector<const btCollisionObject*> all;
  for (const ContactWorld* world : worlds) {
    for (const btCollisionObject* collider : world->colliders()) all.push_back(collider);
  }
  Deepest deepest;
  for (const btCollisionObject* one : all) {
    const btMultiBodyLinkCollider* link = in_world(*one) ? nullptr : btMultiBodyLinkCollider::upcast(one);
    if (link == nullptr) continue;
    for (const btCollisionObject* other : all) {
      const btMultiBodyLinkCollider* theirs = btMultiBodyLinkCollider::upcast(other);
      if (theirs != nullptr && theirs->m_multiBody == link->m_multiBody) continue;
      const double depth_m = depth_between_m(*link, *other);
      if (depth_m > deepest.depth_m) deepest = {link, other, depth_m};
    }
  }
  return deepest;
}

std::string no_room(const std::string& hand) {
  return hand + ": other robots and objects leave no room within " + printed("%g", room_max_m) + " m of this place";
}

}  // namespace kadans::bullet

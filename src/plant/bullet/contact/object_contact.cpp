#include "object_contact.h"

#include <array>
#include <new>

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btCompoundCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>

#include "part_contact.h"

namespace kadans::bullet {
namespace {

constexpr double same_point_m = 0.005;

struct Remembered {
  btVector3 on_a;  // in a's frame
  LastImpulse impulse;
};

// What the solver starts from at points that touched in the last step already; each serves once.
class LastPoints {
 public:
  explicit LastPoints(const btPersistentManifold& manifold) {
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      points_[count_++] = {point.m_localPointA, LastImpulse(point)};
    }
  }
  LastImpulse take(const btVector3& on_a) {
    std::size_t best = count_;
    double nearest = same_point_m * same_point_m;
    for (std::size_t i = 0; i < count_; ++i) {
      const double distance = (points_[i].on_a - on_a).length2();
      if (distance < nearest) nearest = distance, best = i;
    }
    if (best == count_) return {};
    const LastImpulse found = points_[best].impulse;
    points_[best] = points_[--count_];
    return found;
  }

 private:
  std::array<Remembered, MANIFOLD_CACHE_SIZE> points_;
  std::size_t count_ = 0;
};

class ObjectContact final : public PartContact {
 public:
  using PartContact::PartContact;  // the second body has one part

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*, const btDispatcherInfo&,
                        btManifoldResult*) override {
    for (int i = 0; i < manifolds_.size(); ++i) renew_contact(*manifolds_[i], i, 0);
  }
};
static_assert(sizeof(ObjectContact) <= sizeof(btConvexConvexAlgorithm), "fits the dispatcher's pool");

// Whether the boxes around two bodies are clearly apart. Those of the broadphase are wider by Bullet's threshold.
bool apart(const btBroadphaseProxy& a, const btBroadphaseProxy& b) {
  const btScalar gap_m = 1e-6 - 2 * gContactBreakingThreshold;
  for (int i = 0; i < 3; ++i) {
    if (a.m_aabbMax[i] + gap_m < b.m_aabbMin[i] || b.m_aabbMax[i] + gap_m < a.m_aabbMin[i]) return true;
  }
  return false;
}

// Whether Bullet looked at two links before and keeps nothing of their parts.
bool keeps_nothing(const btBroadphasePair& pair, const btCollisionObject& a) {
  if (pair.m_algorithm == nullptr) return false;
  const auto& parts = static_cast<const btCompoundCollisionAlgorithm&>(*pair.m_algorithm);
  for (int i = 0; i < parts_of(a).getNumChildShapes(); ++i) {
    if (parts.getChildAlgorithm(i) != nullptr) return false;
  }
  return true;
}

// Of two links whose boxes are apart Bullet would find out the same, part by part, and leave everything as it is.
void look_at_pair(btBroadphasePair& pair, btCollisionDispatcher& dispatcher, const btDispatcherInfo& info) {
  const auto& a = *static_cast<const btCollisionObject*>(pair.m_pProxy0->m_clientObject);
  const auto& b = *static_cast<const btCollisionObject*>(pair.m_pProxy1->m_clientObject);
  if (!in_world(a) && !in_world(b) && apart(*pair.m_pProxy0, *pair.m_pProxy1) && keeps_nothing(pair, a)) return;
  btCollisionDispatcher::defaultNearCallback(pair, dispatcher, info);
}

}  // namespace

void renew_contact(btPersistentManifold& manifold, int part_a, int part_b) {
  const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
  const ContactSurface surface(a, b);
  LastPoints last(manifold);
  manifold.clearManifold();
  for (const TouchPoint& point : touch_points(a, part_a, b, part_b)) {
    if (!surface.counts(point.distance_m)) continue;
    const btVector3 on_a = a.getWorldTransform().invXform(point.on_a);
    btManifoldPoint contact(on_a, b.getWorldTransform().invXform(point.on_b), point.normal, point.distance_m);
    contact.m_positionWorldOnA = point.on_a;
    contact.m_positionWorldOnB = point.on_b;
    surface.give(contact);
    last.take(on_a).give(contact);
    manifold.addManifoldPoint(contact);
  }
}

void ObjectContactMaker::register_with(btCollisionDispatcher& dispatcher) {
  dispatcher.registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE, this);
  dispatcher.setNearCallback(look_at_pair);
}

btCollisionAlgorithm* ObjectContactMaker::CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                                   const btCollisionObjectWrapper* a,
                                                                   const btCollisionObjectWrapper* b) {
  const btCollisionObject *first = a->getCollisionObject(), *second = b->getCollisionObject();
  if (!in_world(*first) && !in_world(*second)) return links_->CreateCollisionAlgorithm(info, a, b);
  // A link comes before an object, and what moves before what is fixed: the second's faces count first.
  const bool swap = !in_world(*second) || (in_world(*first) && first->isStaticOrKinematicObject());
  if (swap) std::swap(first, second);
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(ObjectContact));
  return new (memory) ObjectContact(info, *first, *second);
}

}  // namespace kadans::bullet

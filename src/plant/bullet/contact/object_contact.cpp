#include "object_contact.h"

#include <array>
#include <new>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btConvexConvexAlgorithm.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "contact_surface.h"
#include "touch_points.h"

namespace kadans::bullet {
namespace {

constexpr double same_point_m = 0.005;

struct Remembered {
  btVector3 on_a;  // in a's frame
  double impulse = 0, lateral1 = 0, lateral2 = 0, rhs = 0;
};

// What the solver starts from at points that touched in the last step already; each serves once.
class LastPoints {
 public:
  explicit LastPoints(const btPersistentManifold& manifold) {
    for (int i = 0; i < manifold.getNumContacts(); ++i) {
      const btManifoldPoint& point = manifold.getContactPoint(i);
      points_[count_++] = {point.m_localPointA, point.m_appliedImpulse, point.m_appliedImpulseLateral1,
                           point.m_appliedImpulseLateral2, point.m_prevRHS};
    }
  }
  Remembered take(const btVector3& on_a) {
    std::size_t best = count_;
    double nearest = same_point_m * same_point_m;
    for (std::size_t i = 0; i < count_; ++i) {
      const double distance = (points_[i].on_a - on_a).length2();
      if (distance < nearest) nearest = distance, best = i;
    }
    if (best == count_) return {};
    const Remembered found = points_[best];
    points_[best] = points_[--count_];
    return found;
  }

 private:
  std::array<Remembered, MANIFOLD_CACHE_SIZE> points_;
  std::size_t count_ = 0;
};

const btConvexShape& part(const btCollisionObject& object, int index) {
  const auto& compound = static_cast<const btCompoundShape&>(*object.getCollisionShape());
  return static_cast<const btConvexShape&>(*compound.getChildShape(index));
}

btTransform part_pose(const btCollisionObject& object, int index) {
  return object.getWorldTransform() *
         static_cast<const btCompoundShape&>(*object.getCollisionShape()).getChildTransform(index);
}

class ObjectContact final : public btCollisionAlgorithm {
 public:
  // `b` has one part.
  ObjectContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObject& a,
                const btCollisionObject& b)
      : btCollisionAlgorithm(info), a_(&a), b_(&b), surface_(a, b) {
    const int parts = static_cast<const btCompoundShape&>(*a.getCollisionShape()).getNumChildShapes();
    manifolds_.reserve(parts);
    for (int i = 0; i < parts; ++i) manifolds_.push_back(info.m_dispatcher1->getNewManifold(&a, &b));
  }
  ~ObjectContact() override {
    for (int i = 0; i < manifolds_.size(); ++i) m_dispatcher->releaseManifold(manifolds_[i]);
  }

  void processCollision(const btCollisionObjectWrapper*, const btCollisionObjectWrapper*, const btDispatcherInfo&,
                        btManifoldResult*) override {
    const btTransform pose_b = part_pose(*b_, 0);
    for (int i = 0; i < manifolds_.size(); ++i) {
      LastPoints last(*manifolds_[i]);
      manifolds_[i]->clearManifold();
      for (const TouchPoint& point : touch_points(part(*a_, i), part_pose(*a_, i), part(*b_, 0), pose_b)) {
        if (surface_.counts(point.distance_m)) add(*manifolds_[i], point, last);
      }
    }
  }

  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) override {
    return 1;
  }

  void getAllContactManifolds(btManifoldArray& all) override {
    for (int i = 0; i < manifolds_.size(); ++i) all.push_back(manifolds_[i]);
  }

 private:
  void add(btPersistentManifold& manifold, const TouchPoint& point, LastPoints& last) const {
    const btVector3 on_a = a_->getWorldTransform().invXform(point.on_a);
    btManifoldPoint contact(on_a, b_->getWorldTransform().invXform(point.on_b), point.normal, point.distance_m);
    contact.m_positionWorldOnA = point.on_a;
    contact.m_positionWorldOnB = point.on_b;
    surface_.give(contact);
    const Remembered before = last.take(on_a);
    contact.m_appliedImpulse = before.impulse;
    contact.m_appliedImpulseLateral1 = before.lateral1;
    contact.m_appliedImpulseLateral2 = before.lateral2;
    contact.m_prevRHS = before.rhs;
    manifold.addManifoldPoint(contact);
  }

  const btCollisionObject* a_;
  const btCollisionObject* b_;
  ContactSurface surface_;
  btManifoldArray manifolds_;  // one a part of a
};
static_assert(sizeof(ObjectContact) <= sizeof(btConvexConvexAlgorithm), "fits the dispatcher's pool");

}  // namespace

void ObjectContactMaker::register_with(btCollisionDispatcher& dispatcher) {
  dispatcher.registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE, this);
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

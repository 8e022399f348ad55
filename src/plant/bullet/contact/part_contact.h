// What the contacts of bodies with convex parts have in common: a manifold for each part of the first body, the
// surfaces' combined properties, and the impulses of the last step.
#pragma once

#include <algorithm>

#include <BulletCollision/BroadphaseCollision/btCollisionAlgorithm.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include "touch_points.h"

namespace kadans::bullet {

// The convex parts of a body.
inline const btCompoundShape& parts_of(const btCollisionObject& body) {
  return static_cast<const btCompoundShape&>(*body.getCollisionShape());
}
inline TouchPoints touch_points(const btCollisionObject& a, int part_a, const btCollisionObject& b, int part_b) {
  const auto part = [](const btCollisionObject& body, int index) -> const btConvexShape& {
    return static_cast<const btConvexShape&>(*parts_of(body).getChildShape(index));
  };
  const auto pose = [](const btCollisionObject& body, int index) {
    return body.getWorldTransform() * parts_of(body).getChildTransform(index);
  };
  return touch_points(part(a, part_a), pose(a, part_a), part(b, part_b), pose(b, part_b));
}

// The combined properties of two surfaces: friction is the product, restitution the greater of both, softness that of
// the one that is soft. A body that bounces has a contact only when it touches: if the solver held it back before, it
// would lose speed before the bounce. On a soft surface its spring and damper say what is given back, no restitution.
class ContactSurface {
 public:
  ContactSurface(const btCollisionObject& a, const btCollisionObject& b)
      : friction_(btManifoldResult::calculateCombinedFriction(&a, &b)),
        restitution_(std::max(a.getRestitution(), b.getRestitution())) {
    for (const btCollisionObject* one : {&a, &b}) {
      if ((one->getCollisionFlags() & btCollisionObject::CF_HAS_CONTACT_STIFFNESS_DAMPING) == 0) continue;
      stiffness_N_per_m_ = one->getContactStiffness();
      damping_Ns_per_m_ = one->getContactDamping();
      restitution_ = 0;
    }
  }

  bool counts(double distance_m) const { return restitution_ == 0 || distance_m < bounce_distance_m; }

  void give(btManifoldPoint& point) const {
    point.m_combinedFriction = friction_;
    point.m_combinedRestitution = restitution_;
    if (stiffness_N_per_m_ > 0) {
      point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
      point.m_combinedContactStiffness1 = stiffness_N_per_m_;
      point.m_combinedContactDamping1 = damping_Ns_per_m_;
    }
    if (restitution_ == 0) return;  // Bullet keeps a contact's own ERP in the same place as its damping
    point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP;
    point.m_contactERP = bounce_erp;  // pushing an overlap out must not add to the bounce
  }

 private:
  static constexpr double bounce_distance_m = 1e-5, bounce_erp = 0.005;
  double friction_, restitution_;
  double stiffness_N_per_m_ = 0, damping_Ns_per_m_ = 0;  // 0 N/m: hard
};

// What the solver made of a point of contact, and starts from in the next step.
struct LastImpulse {
  double normal = 0, lateral1 = 0, lateral2 = 0, rhs = 0;

  LastImpulse() = default;
  explicit LastImpulse(const btManifoldPoint& point)
      : normal(point.m_appliedImpulse),
        lateral1(point.m_appliedImpulseLateral1),
        lateral2(point.m_appliedImpulseLateral2),
        rhs(point.m_prevRHS) {}
  void give(btManifoldPoint& point) const {
    point.m_appliedImpulse = normal;
    point.m_appliedImpulseLateral1 = lateral1;
    point.m_appliedImpulseLateral2 = lateral2;
    point.m_prevRHS = rhs;
  }
};

// A contact of two bodies with a manifold for each part of the first one.
class PartContact : public btCollisionAlgorithm {
 public:
  PartContact(const btCollisionAlgorithmConstructionInfo& info, const btCollisionObject& a, const btCollisionObject& b)
      : btCollisionAlgorithm(info) {
    const int parts = parts_of(a).getNumChildShapes();
    manifolds_.reserve(parts);
    for (int i = 0; i < parts; ++i) manifolds_.push_back(info.m_dispatcher1->getNewManifold(&a, &b));
  }
  ~PartContact() override {
    for (int i = 0; i < manifolds_.size(); ++i) m_dispatcher->releaseManifold(manifolds_[i]);
  }
  btScalar calculateTimeOfImpact(btCollisionObject*, btCollisionObject*, const btDispatcherInfo&,
                                 btManifoldResult*) final {
    return 1;
  }
  void getAllContactManifolds(btManifoldArray& all) final {
    for (int i = 0; i < manifolds_.size(); ++i) all.push_back(manifolds_[i]);
  }

 protected:
  btManifoldArray manifolds_;
};

}  // namespace kadans::bullet

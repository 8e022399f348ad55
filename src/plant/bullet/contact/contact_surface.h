// The combined properties of two surfaces: friction is the product, restitution the greater of both. A body that
// bounces has a contact only when it touches: if the solver held it back before, it would lose speed before the bounce.
#pragma once

#include <algorithm>

#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

namespace kadans::bullet {

class ContactSurface {
 public:
  ContactSurface(const btCollisionObject& a, const btCollisionObject& b)
      : friction_(btManifoldResult::calculateCombinedFriction(&a, &b)),
        restitution_(std::max(a.getRestitution(), b.getRestitution())) {}

  bool counts(double distance_m) const { return restitution_ == 0 || distance_m < bounce_distance_m; }

  void give(btManifoldPoint& point) const {
    point.m_combinedFriction = friction_;
    point.m_combinedRestitution = restitution_;
    if (restitution_ == 0) return;
    point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP;
    point.m_contactERP = bounce_erp;  // pushing an overlap out must not add to the bounce
  }

 private:
  static constexpr double bounce_distance_m = 1e-5, bounce_erp = 0.005;
  double friction_, restitution_;
};

}  // namespace kadans::bullet

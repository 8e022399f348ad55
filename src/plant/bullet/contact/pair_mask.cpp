#include "pair_mask.h"

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "plant/bullet/convert.h"

namespace kadans::bullet {

bool PairMask::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const bool wanted = (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
                      (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
  if (!wanted) return false;
  const auto* link_a = btMultiBodyLinkCollider::upcast(static_cast<btCollisionObject*>(a->m_clientObject));
  const auto* link_b = btMultiBodyLinkCollider::upcast(static_cast<btCollisionObject*>(b->m_clientObject));
  if (link_a == nullptr || link_b == nullptr || link_a->m_multiBody != link_b->m_multiBody) return true;
  return allowed(model_link(link_a->m_link), model_link(link_b->m_link));
}

}  // namespace kadans::bullet

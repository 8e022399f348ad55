#include "link_contact.h"

#include <algorithm>

#include "plant/bullet/convert.h"

namespace kadans::bullet {
namespace {

// The collider of one of the robot's links, or null.
const btMultiBodyLinkCollider* link_collider(const Body& body, const btCollisionObject* object) {
  const auto* collider = btMultiBodyLinkCollider::upcast(object);
  return collider != nullptr && collider->m_multiBody == &body.multibody() ? collider : nullptr;
}

double overlap_m(const btPersistentManifold& manifold) {
  double overlap = 0;
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    overlap = std::max(overlap, -static_cast<double>(manifold.getContactPoint(i).getDistance()));
  }
  return overlap;
}

void forget(PlantTruth& truth) {
  truth.ground_links.reset();
  truth.robot_links.reset();
  truth.robots_force_N = {};
  truth.touching_links.reset();
  truth.contact_count = 0;
  truth.self_penetration_m = 0;
  for (std::size_t i = 0; i < truth.object_count; ++i) {
    truth.objects[i].force_N = {};
    truth.objects[i].links.reset();
  }
}

// `force_N`: from the link.
void add_contact(const LinkContact& contact, const ContactWorld& world, const btVector3& force_N, PlantTruth& truth) {
  truth.touching_links.set(contact.link);
  if (contact.other == &world.ground()) {
    truth.ground_links.set(contact.link);
    return;
  }
  if (!in_world(*contact.other)) {
    truth.robot_links.set(contact.link);
    truth.robots_force_N = from_bullet(to_bullet(truth.robots_force_N) - force_N);
    return;
  }
  ObjectTruth& object = truth.objects[static_cast<std::size_t>(contact.other->getUserIndex())];
  object.links.set(contact.link);
  object.force_N = from_bullet(to_bullet(object.force_N) + force_N);
}

}  // namespace

LinkContact link_contact(const Body& body, const btPersistentManifold& manifold) {
  const auto* first = link_collider(body, manifold.getBody0());
  const auto* second = link_collider(body, manifold.getBody1());
  if ((first == nullptr) == (second == nullptr)) return {};
  if (first != nullptr) return {model_link(first->m_link), manifold.getBody1(), true};
  return {model_link(second->m_link), manifold.getBody0(), false};
}

btVector3 contact_impulse(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

void read_contacts(const ContactWorld& world, const Body& body, double dt_s, PlantTruth& truth) {
  forget(truth);
  for (int i = 0; i < world.manifold_count(); ++i) {
    const btPersistentManifold& manifold = world.manifold(i);
    const LinkContact contact = link_contact(body, manifold);
    if (contact.other == nullptr) {
      const bool own = link_collider(body, manifold.getBody0()) != nullptr;
      if (own) truth.self_penetration_m = std::max(truth.self_penetration_m, overlap_m(manifold));
      continue;
    }
    btVector3 impulse(0, 0, 0);
    bool presses = false;
    for (int j = 0; j < manifold.getNumContacts(); ++j) {
      const btManifoldPoint& point = manifold.getContactPoint(j);
      presses = presses || point.m_appliedImpulse > 0;
      if (point.m_appliedImpulse > 0) ++truth.contact_count;
      impulse += contact_impulse(point);
    }
    if (presses) add_contact(contact, world, (contact.link_is_first ? -1 : 1) * impulse / dt_s, truth);
  }
}

}  // namespace kadans::bullet

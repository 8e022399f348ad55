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

// A contact between a link of the robot and something that is not the robot.
struct LinkContact {
  std::size_t link = 0;
  const btCollisionObject* other = nullptr;  // ground, object or another robot's link; null: no such contact
  bool link_is_first = false;                // the contact's normals point to the first body
};

LinkContact link_contact(const Body& body, const btPersistentManifold& manifold) {
  const auto* first = link_collider(body, manifold.getBody0());
  const auto* second = link_collider(body, manifold.getBody1());
  if ((first == nullptr) == (second == nullptr)) return {};
  if (first != nullptr) return {model_link(first->m_link), manifold.getBody1(), true};
  return {model_link(second->m_link), manifold.getBody0(), false};
}

// Of the last step, on the first body.
btVector3 contact_impulse(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
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

// Where `value` lies between two ends: 0 at the first, 1 at the second, never outside.
double between(double value, double first, double second) {
  return first == second ? 0.5 : std::clamp((value - first) / (second - first), 0.0, 1.0);
}

// Distributes a normal force at a point of the sole over four sensors at its corners: bilinear between heel and toe,
// inner and outer. So the sum is the force, and the centre of pressure is kept inside the corners.
std::array<double, sensors_per_foot> foot_pressure(const FootSettings& foot, const btVector3& point_in_link_m,
                                                   double force_N) {
  const auto& [heel_inner, heel_outer, toe_inner, toe_outer] = foot.sensors_m;
  const double toe =
      between(point_in_link_m.x(), (heel_inner[0] + heel_outer[0]) / 2, (toe_inner[0] + toe_outer[0]) / 2);
  const double outer =
      between(point_in_link_m.y(), (heel_inner[1] + toe_inner[1]) / 2, (heel_outer[1] + toe_outer[1]) / 2);
  return {force_N * (1 - toe) * (1 - outer), force_N * (1 - toe) * outer, force_N * toe * (1 - outer),
          force_N * toe * outer};
}

void add_contact(const btManifoldPoint& point, bool link_is_first, const btTransform& link_frame,
                 const FootSettings& settings, double dt_s, FootLoad& load) {
  load.force_N += (link_is_first ? 1 : -1) * contact_impulse(point) / dt_s;
  const btVector3 at = link_is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const auto share = foot_pressure(settings, link_frame.inverse() * at, point.m_appliedImpulse / dt_s);
  for (std::size_t i = 0; i < share.size(); ++i) load.pressure_N[i] += share[i];
}

}  // namespace

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

void read_feet(const ContactWorld& world, const Body& body, const std::vector<FootSettings>& settings, double dt_s,
               std::vector<FootLoad>& feet) {
  for (FootLoad& load : feet) {
    load.force_N.setZero();
    load.pressure_N.fill(0);
  }
  for (int i = 0; i < world.manifold_count(); ++i) {
    const btPersistentManifold& manifold = world.manifold(i);
    const LinkContact contact = link_contact(body, manifold);
    if (contact.other == nullptr) continue;
    for (std::size_t foot = 0; foot < feet.size(); ++foot) {
      if (feet[foot].link != contact.link) continue;
      const btTransform frame = body.link_frame(contact.link);
      for (int j = 0; j < manifold.getNumContacts(); ++j) {
        add_contact(manifold.getContactPoint(j), contact.link_is_first, frame, settings[foot], dt_s, feet[foot]);
      }
    }
  }
}

}  // namespace kadans::bullet

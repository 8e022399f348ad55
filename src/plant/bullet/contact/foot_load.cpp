#include <algorithm>

#include "link_contact.h"
#include "plant/bullet/sensors.h"

namespace kadans::bullet {
namespace {

// Where `value` lies between two ends: 0 at the first, 1 at the second, never outside.
double between(double value, double first, double second) {
  return first == second ? 0.5 : std::clamp((value - first) / (second - first), 0.0, 1.0);
}

void add_contact(const btManifoldPoint& point, bool link_is_first, const btTransform& link_frame,
                 const FootSettings& settings, double dt_s, FootLoad& load) {
  load.force_N += (link_is_first ? 1 : -1) * contact_impulse(point) / dt_s;
  const btVector3 at = link_is_first ? point.getPositionWorldOnA() : point.getPositionWorldOnB();
  const auto share = foot_pressure(settings, link_frame.inverse() * at, point.m_appliedImpulse / dt_s);
  for (std::size_t i = 0; i < share.size(); ++i) load.pressure_N[i] += share[i];
}

}  // namespace

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

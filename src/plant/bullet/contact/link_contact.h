// A contact between a link of a robot and something that is not the robot.
#pragma once

#include "kadans/plant/world.h"
#include "plant/bullet/body.h"

namespace kadans::bullet {

struct LinkContact {
  std::size_t link = 0;
  const btCollisionObject* other = nullptr;  // ground, object or another robot's link; null: no such contact
  bool link_is_first = false;                // the contact's normals point to the first body
};
LinkContact link_contact(const Body& body, const btPersistentManifold& manifold);

btVector3 contact_impulse(const btManifoldPoint& point);  // of the last step, on the first body

// Reads what touches what after a step of dt_s.
void read_contacts(const ContactWorld& world, const Body& body, double dt_s, PlantTruth& truth);

}  // namespace kadans::bullet

// Room for what hands put down: what begins deep in something else would be thrown out of it, at any speed.
#pragma once

#include <span>
#include <string>

#include "contact_world.h"

namespace kadans::bullet {

// How far from its place a thing is put down when something stands there, and in which steps.
inline constexpr double room_step_m = 0.1, room_max_m = 3;

// Whether a part of this body lies deep in another body that moves, by the boxes along the world's axes around both, or
// in something fixed. May allocate.
bool is_crowded(const btMultiBody& body, std::span<ContactWorld* const> worlds);

// Where a part of a robot lies deepest in another robot, or in an object.
struct Deepest {
  const btMultiBodyLinkCollider* link = nullptr;
  const btCollisionObject* other = nullptr;
  double depth_m = 0;
};
// May allocate.
Deepest deepest_in_others(std::span<ContactWorld* const> worlds);

// "carry: other robots and objects leave no room within 3 m of this place".
std::string no_room(const std::string& hand);

}  // namespace kadans::bullet

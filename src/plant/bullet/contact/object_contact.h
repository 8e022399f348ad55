// Contacts with the objects of the world: between the robot's links and objects, and between objects. touch_points.h
// finds where they touch. Here a point keeps its impulse from one step to the next, as in ground_contact.h. Contacts of
// the robot with itself are left to Bullet, those between robots to robot_contacts.h.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace kadans::bullet {

// An object of the world carries its number as its user index, counted from 0; links and ground have -1.
inline bool in_world(const btCollisionObject& object) { return object.getUserIndex() >= 0; }

// Finds the points anew at which these parts of the manifold's two bodies touch. A point that is where one was keeps
// its impulse.
void renew_contact(btPersistentManifold& manifold, int part_a, int part_b);

class ObjectContactMaker final : public btCollisionAlgorithmCreateFunc {
 public:
  // `links` makes the algorithm for contacts between the robot's own links.
  explicit ObjectContactMaker(btCollisionAlgorithmCreateFunc& links) : links_(&links) {}
  void register_with(btCollisionDispatcher& dispatcher);
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;

 private:
  btCollisionAlgorithmCreateFunc* links_;
};

}  // namespace kadans::bullet

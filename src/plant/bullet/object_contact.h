// Contact with the objects of the world: of the robot's links with them, and of one with another. Who touches where is
// touch_points.h's; here a point remembers its impulse from one step to the next, as in ground_contact.h. Contact of
// the robot with itself stays Bullet's own.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace kadans::bullet {

// An object of the world carries its number as its user index, counted from 0; links and ground have -1.
inline bool in_world(const btCollisionObject& object) { return object.getUserIndex() >= 0; }

class ObjectContactMaker final : public btCollisionAlgorithmCreateFunc {
 public:
  // `links` makes what the robot's own links get among each other.
  explicit ObjectContactMaker(btCollisionAlgorithmCreateFunc& links) : links_(&links) {}
  void register_with(btCollisionDispatcher& dispatcher);
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;

 private:
  btCollisionAlgorithmCreateFunc* links_;
};

}  // namespace kadans::bullet

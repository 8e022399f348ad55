// Contact of a body's shapes with the ground's plane, exact: each step the corners of every shape that lie
// nearest to the plane become its contact points (at most four per shape), normal to the ground and at their true
// distance. Points still above the ground are contacts too, within contact_distance_m: the solver lets them come down
// as far as the ground and no further. A corner remembers its impulse from one step to the next, which is where the
// solver starts from. Bullet's own box against box detector tilts the normal with the foot and lets standing feet
// creep.
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionCreateFunc.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>

namespace kadans::bullet {

// Makes the dispatcher use this for every compound shape on a static plane with normal z in the ground's own frame.
class GroundContactMaker final : public btCollisionAlgorithmCreateFunc {
 public:
  void register_with(btCollisionDispatcher& dispatcher);
  btCollisionAlgorithm* CreateCollisionAlgorithm(btCollisionAlgorithmConstructionInfo& info,
                                                 const btCollisionObjectWrapper* a,
                                                 const btCollisionObjectWrapper* b) override;
};

}  // namespace kadans::bullet

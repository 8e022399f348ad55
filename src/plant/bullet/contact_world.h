// Bullet's world with one robot on level ground, set up so that it is physics and repeats bit for bit.
//
// What differs from Bullet's defaults, and why:
// - no split impulse: the multibody solver never applies the split part, so joint limits would vanish;
// - friction cone off, two fixed friction directions: standing feet do not creep;
// - islands unused (one robot is one island), nothing sleeps: the order of the solver is the same every run. Pairs keep
//   the order they came in, which a new world repeats; Bullet's option to sort them allocates in every step;
// - the solver starts from the last step's impulses and runs all its iterations (residual threshold 0); in a step in
//   which a joint runs into its limit it runs limit_iterations_factor times as many, because a light foot between the
//   ground and an ankle's limit is where the iteration converges slowest.
// A step follows btDiscreteDynamicsWorld's own order, less what only islands and continuous collision need:
// collide, accelerate (articulated body algorithm), solve contacts and rows, move, update the frames once.
// Not thread-safe; one world a plant.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include "ground_contact.h"
#include "joint_rows.h"
#include "pair_mask.h"

namespace kadans::bullet {

inline constexpr int limit_iterations_factor = 5;

class SteppedWorld;

class ContactWorld {
 public:
  struct Options {
    btVector3 gravity_m_s2;
    int solver_iterations = 10;
    double ground_friction = 1;
  };

  ContactWorld(const Options& options, PairMask& mask);  // keeps a reference to the mask
  ~ContactWorld();
  ContactWorld(const ContactWorld&) = delete;
  ContactWorld& operator=(const ContactWorld&) = delete;

  void add(btMultiBody& body);
  void add(btCollisionObject& collider, bool fixed);
  void add(JointRows& rows);

  void step(double dt_s);
  void detect_collisions();  // without a step

  const btCollisionObject& ground() const { return ground_; }
  int manifold_count() const;
  const btPersistentManifold& manifold(int index) const;

 private:
  GroundContactMaker ground_contact_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  std::unique_ptr<SteppedWorld> world_;
  btStaticPlaneShape ground_shape_{btVector3(0, 0, 1), 0};
  btCollisionObject ground_;
};

}  // namespace kadans::bullet

// Bullet's world with one robot on a plane and other objects, set up so that it is physics and repeats bit for bit.
//
// What differs from Bullet's defaults, and why:
// - no split impulse: the multibody solver never applies the split part, so joint limits would vanish;
// - friction cone off, two fixed friction directions: standing feet do not creep;
// - islands unused (one robot is one island), nothing sleeps: the order of the solver is the same every run. Pairs keep
//   the order they came in, which a new world repeats; Bullet's option to sort them allocates in every step;
// - the solver starts from the last step's impulses; Bullet's own runs all its iterations (residual threshold 0).
// A step follows btDiscreteDynamicsWorld's own order, without what only islands and continuous collision need:
// collide, accelerate (articulated body algorithm), solve contacts and rows, move, update the frames once.
// Not thread-safe; one world a robot (robot_contacts.h).
#pragma once

#include <array>
#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include "ground_contact.h"
#include "kadans/plant/settings.h"
#include "object_contact.h"
#include "plant/bullet/joint/joint_rows.h"
#include "plant/bullet/solver/tree_solver.h"
#include "rolling_rows.h"
#include "shapes.h"

namespace kadans::bullet {

class SteppedWorld;

class ContactWorld {
 public:
  // Keeps a reference to the mask. `friction` is for our own solver.
  ContactWorld(const PlantSettings& settings, PairMask& mask, FrictionLaw friction = FrictionLaw::cone);
  ~ContactWorld();
  ContactWorld(const ContactWorld&) = delete;
  ContactWorld& operator=(const ContactWorld&) = delete;

  void add(btMultiBody& body);
  void add(btCollisionObject& collider, bool fixed);  // of a multibody, or of what only drive() moves
  void add(JointRows& rows);
  void add(RollingRows& rows);

  // For the next step: the velocity of a driven body, which nothing stops, in its contacts. The step also moves the
  // body, unless `stays`.
  void drive(btRigidBody& body, const btVector3& velocity_m_s, bool stays);
  void drive_ground(const btVector3& velocity_m_s);

  void step(double dt_s);
  // The same in parts, around the solver's work for group(), which needs the tree solver.
  void begin_step(double dt_s);
  TreeSolver::Group group();
  void end_step(double dt_s);
  void detect_collisions();  // without a step

  // A contact with what stands in another world, for the step that has begun. One of the two worlds solves it.
  void cross(btPersistentManifold& manifold, bool solved_here);
  void reserve_crossing(std::size_t manifolds);

  const btCollisionObject& ground() const { return ground_; }
  std::vector<const btCollisionObject*> colliders() const;         // without the ground
  double normal_impulse(const btCollisionObject& collider) const;  // of all its contacts in the last step
  int manifold_count() const;                                      // with those of the last step that cross
  double residual_m_s() const { return tree_solver_.residual(); }  // tree_solver.h
  const btPersistentManifold& manifold(int index) const;

 private:
  GroundContactMaker ground_contact_;
  btDefaultCollisionConfiguration configuration_;
  ObjectContactMaker object_contact_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver stock_solver_;
  TreeSolver tree_solver_;
  std::unique_ptr<SteppedWorld> world_;
  btStaticPlaneShape ground_shape_{btVector3(0, 0, 1), 0};
  btRigidBody ground_{0, nullptr, &ground_shape_};
  std::vector<btPersistentManifold*> crossing_, solved_crossing_;
};

}  // namespace kadans::bullet

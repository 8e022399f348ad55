#include "contact_world.h"

#include <algorithm>

#include "plant/bullet/bullet_memory.h"
#include "plant/bullet/convert.h"

namespace kadans::bullet {
class SteppedWorld final : public btMultiBodyDynamicsWorld {
 public:
  // With an own solver, which takes the free motion along with the contacts.
  SteppedWorld(bool own_solver, btDispatcher* dispatcher, btBroadphaseInterface* pairs,
               btMultiBodyConstraintSolver* solver, btCollisionConfiguration* configuration)
      : btMultiBodyDynamicsWorld(dispatcher, pairs, solver, configuration), own_solver_(own_solver) {}

  // begin, solve and end are stepSimulation and internalSingleStepSimulation of one step.
  void begin(btScalar dt_s) {
    saveKinematicState(dt_s);
    applyGravity();
    for (const Driven& driven : driven_) driven.body->setLinearVelocity(driven.velocity_m_s);
    getDispatchInfo().m_timeStep = dt_s;
    performDiscreteCollisionDetection();
    getSolverInfo().m_timeStep = dt_s;
    if (!own_solver_) accelerate(dt_s);
  }

  void solve() {
    btPersistentManifold** manifolds = getDispatcher()->getInternalManifoldPointer();
    const int manifold_count = getDispatcher()->getNumManifolds();
    btMultiBodyConstraint** rows = m_multiBodyConstraints.size() > 0 ? &m_multiBodyConstraints[0] : nullptr;
    m_multiBodyConstraintSolver->solveMultiBodyGroup(&m_collisionObjects[0], m_collisionObjects.size(), manifolds,
                                                     manifold_count, nullptr, 0, rows, m_multiBodyConstraints.size(),
                                                     getSolverInfo(), nullptr, getDispatcher());
    if (own_solver_) return;
    for (int i = 0; i < m_multiBodies.size(); ++i) m_multiBodies[i]->processDeltaVeeMultiDof2();
  }

  void end(btScalar dt_s) {
    move(dt_s);
    move_driven(dt_s);
    synchronizeMotionStates();
    clearForces();
  }

  void drive(btRigidBody& body, const btVector3& velocity_m_s, bool stays) {
    driven_.push_back({&body, velocity_m_s, stays});
  }

  void update_frames() {
    for (int i = 0; i < m_multiBodies.size(); ++i) update_frames(*m_multiBodies[i]);
  }

 private:
  void accelerate(double dt_s) {
    for (int i = 0; i < m_multiBodies.size(); ++i) {
      m_multiBodies[i]->clearConstraintForces();
      m_multiBodies[i]->computeAccelerationsArticulatedBodyAlgorithmMultiDof(dt_s, m_scratch_r, m_scratch_v,
                                                                             m_scratch_m, false, false, false);
    }
  }

  void move(double dt_s) {
    for (int i = 0; i < m_multiBodies.size(); ++i) {
      m_multiBodies[i]->stepPositionsMultiDof(dt_s);
      update_frames(*m_multiBodies[i]);
    }
  }

  void move_driven(double dt_s) {
    for (const Driven& driven : driven_) {
      btTransform& pose = driven.body->getWorldTransform();
      if (!driven.stays) pose.setOrigin(pose.getOrigin() + dt_s * driven.velocity_m_s);
    }
    driven_.clear();
  }

  void update_frames(btMultiBody& body) {
    body.forwardKinematics(m_scratch_world_to_local, m_scratch_local_origin);
    if (body.getBaseCollider() != nullptr) body.getBaseCollider()->setWorldTransform(body.getBaseWorldTransform());
    for (int i = 0; i < body.getNumLinks(); ++i) {
      btMultibodyLink& link = body.getLink(i);
      if (link.m_collider != nullptr) link.m_collider->setWorldTransform(link.m_cachedWorldTransform);
    }
  }

  struct Driven {
    btRigidBody* body;
    btVector3 velocity_m_s;
    bool stays;
  };

  bool own_solver_;
  std::vector<Driven> driven_;  // in the next step
};

namespace {

// Bullet's own pools hold 4096 of each and cost 8 MB, and milliseconds at every start.
btDefaultCollisionConstructionInfo small_pools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 512;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 512;
  return info;
}

}  // namespace

ContactWorld::ContactWorld(const PlantSettings& settings, PairMask& mask, FrictionLaw friction)
    : configuration_(small_pools()),
      object_contact_(
          *configuration_.getCollisionAlgorithmCreateFunc(COMPOUND_SHAPE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE)),
      dispatcher_(&configuration_),
      tree_solver_(friction) {
  reserve_bullet_memory();
  ground_contact_.register_with(dispatcher_);
  object_contact_.register_with(dispatcher_);
  const bool own = settings.solver != ContactSolver::stock;
  btMultiBodyConstraintSolver& solver = own ? tree_solver_ : stock_solver_;
  world_ = std::make_unique<SteppedWorld>(own, &dispatcher_, &broadphase_, &solver, &configuration_);
  world_->setGravity(to_bullet(settings.gravity_m_s2));
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(&mask);
  world_->getDispatchInfo().m_useContinuous = false;
  btContactSolverInfo& info = world_->getSolverInfo();
  info.m_splitImpulse = false;
  info.m_solverMode |=
      SOLVER_DISABLE_IMPLICIT_CONE_FRICTION | SOLVER_USE_2_FRICTION_DIRECTIONS | SOLVER_USE_ARTICULATED_WARMSTARTING;
  info.m_numIterations = settings.solver_iterations;
  info.m_minimumSolverBatchSize = 0;
  info.m_leastSquaresResidualThreshold = 0;
  ground_.setWorldTransform(to_bullet(ground_pose(settings.world)));
  ground_.setFriction(settings.ground_friction);
  ground_.setRestitution(settings.ground_restitution);
  if (settings.ground_stiffness_N_per_m > 0)
    ground_.setContactStiffnessAndDamping(settings.ground_stiffness_N_per_m, settings.ground_damping_Ns_per_m);
  world_->addCollisionObject(&ground_, btBroadphaseProxy::StaticFilter, btBroadphaseProxy::DefaultFilter);
}

ContactWorld::~ContactWorld() {
  // The robot's parts belong to others, who may be gone: take everything out before Bullet looks at it.
  for (int i = world_->getNumMultiBodyConstraints() - 1; i >= 0; --i) {
    world_->removeMultiBodyConstraint(world_->getMultiBodyConstraint(i));
  }
  for (int i = world_->getNumMultibodies() - 1; i >= 0; --i) world_->removeMultiBody(world_->getMultiBody(i));
  for (int i = world_->getNumCollisionObjects() - 1; i >= 0; --i) {
    world_->removeCollisionObject(world_->getCollisionObjectArray()[i]);
  }
}

void ContactWorld::add(btMultiBody& body) {
  world_->addMultiBody(&body);
  tree_solver_.add(body);
  world_->update_frames();
}

void ContactWorld::add(btCollisionObject& collider, bool fixed) {
  const int everything = btBroadphaseProxy::DefaultFilter | btBroadphaseProxy::StaticFilter;
  world_->addCollisionObject(&collider, fixed ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter,
                             fixed ? btBroadphaseProxy::DefaultFilter : everything);
}

void ContactWorld::add(JointRows& rows) {
  world_->addMultiBodyConstraint(&rows);
  tree_solver_.add(rows);
}

void ContactWorld::add(RollingRows& rows) {
  world_->addMultiBodyConstraint(&rows);
  tree_solver_.add(rows);
}

void ContactWorld::drive(btRigidBody& body, const btVector3& velocity_m_s, bool stays) {
  world_->drive(body, velocity_m_s, stays);
}

// As far as it runs along itself the plane stays the same plane.
void ContactWorld::drive_ground(const btVector3& velocity_m_s) {
  ground_.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  world_->drive(ground_, velocity_m_s, false);
}

void ContactWorld::step(double dt_s) {
  begin_step(dt_s);
  world_->solve();
  end_step(dt_s);
}

void ContactWorld::begin_step(double dt_s) {
  crossing_.clear();
  solved_crossing_.clear();
  world_->begin(dt_s);
}

TreeSolver::Group ContactWorld::group() {
  return {
      .solver = &tree_solver_,
      .manifolds = {dispatcher_.getInternalManifoldPointer(), static_cast<std::size_t>(dispatcher_.getNumManifolds())},
      .crossing = solved_crossing_,
      .info = &world_->getSolverInfo()};
}

void ContactWorld::end_step(double dt_s) { world_->end(dt_s); }

void ContactWorld::cross(btPersistentManifold& manifold, bool solved_here) {
  crossing_.push_back(&manifold);
  if (solved_here) solved_crossing_.push_back(&manifold);
}

void ContactWorld::reserve_crossing(std::size_t manifolds) {
  crossing_.reserve(manifolds);
  solved_crossing_.reserve(manifolds);
  tree_solver_.reserve_contacts(manifolds);
}

std::vector<const btCollisionObject*> ContactWorld::colliders() const {
  const auto& all = world_->getCollisionObjectArray();
  std::vector<const btCollisionObject*> colliders;
  for (int i = 0; i < all.size(); ++i) {
    if (all[i] != &ground_) colliders.push_back(all[i]);
  }
  return colliders;
}

void ContactWorld::detect_collisions() {
  world_->update_frames();
  world_->performDiscreteCollisionDetection();
}

double ContactWorld::normal_impulse(const btCollisionObject& collider) const {
  double sum = 0;
  for (int i = 0; i < manifold_count(); ++i) {
    const btPersistentManifold& contact = manifold(i);
    if (contact.getBody0() != &collider && contact.getBody1() != &collider) continue;
    for (int j = 0; j < contact.getNumContacts(); ++j) sum += contact.getContactPoint(j).m_appliedImpulse;
  }
  return sum;
}

int ContactWorld::manifold_count() const { return dispatcher_.getNumManifolds() + static_cast<int>(crossing_.size()); }

const btPersistentManifold& ContactWorld::manifold(int index) const {
  const int own = dispatcher_.getNumManifolds();
  if (index >= own) return *crossing_[static_cast<std::size_t>(index - own)];
  return *const_cast<btCollisionDispatcher&>(dispatcher_).getManifoldByIndexInternal(index);
}

}  // namespace kadans::bullet

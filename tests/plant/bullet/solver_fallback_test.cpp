// Worlds that the plant's own solver does not cover, which no settings make: it must know them, and leave them to
// Bullet's solver bit for bit.
#include <memory>

#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <doctest/doctest.h>

#include "plant/bullet/body.h"
#include "plant/bullet/contact/contact_world.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::bullet;
using namespace kadans::test;

namespace {

constexpr double dt_s = 1e-3;

ContactWorld::Options options(ContactSolver solver) {
  return {.gravity_m_s2 = {0, 0, -g}, .solver_iterations = 50, .solver = solver};
}

// A cube of 2 kg that belongs to a robot, and upon it one of 1 kg that is none of Bullet's multibodies.
struct LooseCube {
  explicit LooseCube(ContactSolver solver)
      : body(robot.model, robot.settings),
        mask(make_pair_mask(robot.model, robot.settings, body)),
        world(options(solver), mask) {
    body.place(robot.settings);
    body.add_to(world);
    compound.addChildShape(btTransform::getIdentity(), &shape);
    btVector3 moments;
    compound.calculateLocalInertia(1, moments);
    loose = std::make_unique<btRigidBody>(btRigidBody::btRigidBodyConstructionInfo(1, nullptr, &compound, moments));
    loose->setWorldTransform(btTransform(btQuaternion::getIdentity(), {0.02, 0, 0.4}));
    loose->setGravity({0, 0, -g});
    loose->setActivationState(DISABLE_DEACTIVATION);
    world.add(*loose, false);
  }

  Robot robot = box(2, {0.2, 0.2, 0.2});
  Body body;
  PairMask mask;
  btBoxShape shape{btVector3(0.05, 0.05, 0.05)};
  btCompoundShape compound{false};
  std::unique_ptr<btRigidBody> loose;
  ContactWorld world;
};

// A multibody of two links that hang from a base, without shapes.
std::unique_ptr<btMultiBody> hanging(bool ball_joints) {
  auto body = std::make_unique<btMultiBody>(2, 1, btVector3(1, 1, 1), true, false);
  for (int link = 0; link < 2; ++link) {
    const btVector3 moments(0.01, 0.02, 0.03), to_pivot(0.1, 0, link == 0 ? 0 : -0.2), to_com(0, 0, -0.2);
    const btQuaternion straight = btQuaternion::getIdentity();
    if (ball_joints) {
      body->setupSpherical(link, 1, moments, link - 1, straight, to_pivot, to_com, false);
    } else {
      body->setupRevolute(link, 1, moments, link - 1, straight, {0, 1, 0}, to_pivot, to_com, false);
    }
  }
  body->finalizeMultiDof();
  body->setBaseWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0, 2}));
  body->setLinearDamping(0);
  body->setAngularDamping(0);
  btAlignedObjectArray<btQuaternion> rotations;
  btAlignedObjectArray<btVector3> origins;
  body->forwardKinematics(rotations, origins);
  return body;
}

btVector3 end_m(const btMultiBody& body) { return body.getLink(1).m_cachedWorldTransform.getOrigin(); }

// Where the second link is after a second.
struct Hung {
  Hung(ContactSolver solver, bool ball_joints, bool tied)
      : body(hanging(ball_joints)), tie(body.get(), 1, nullptr, {0, 0, 0}, end_m(*body)), world(options(solver), mask) {
    world.add(*body);
    const btVector3 start_m = end_m(*body);
    if (tied) world.add(tie);
    for (int i = 0; i < 1000; ++i) world.step(dt_s);
    way_m = end_m(*body) - start_m;
  }

  PairMask mask{3};
  std::unique_ptr<btMultiBody> body;
  btMultiBodyPoint2Point tie;
  btVector3 way_m;
  ContactWorld world;
};

}  // namespace

TEST_CASE("A rigid body that moves freely is left to Bullet's solver, which lets it fall, land and weigh on a robot") {
  LooseCube tree(ContactSolver::tree), stock(ContactSolver::stock);
  int apart = 0;
  for (int i = 0; i < 1500; ++i) {
    for (LooseCube* cube : {&tree, &stock}) cube->world.step(dt_s);
    const bool same = tree.loose->getWorldTransform() == stock.loose->getWorldTransform() &&
                      tree.body.com_frame(0) == stock.body.com_frame(0);
    apart += same ? 0 : 1;
  }
  CHECK(apart == 0);
  CHECK(tree.loose->getWorldTransform().getOrigin().z() == doctest::Approx(0.25).epsilon(2e-3));
  CHECK(tree.world.normal_impulse(tree.world.ground()) == doctest::Approx(3 * g * dt_s).epsilon(1e-3));
}

TEST_CASE("Joints of several degrees of freedom are left to Bullet's solver") {
  const Hung tree(ContactSolver::tree, true, false), stock(ContactSolver::stock, true, false);
  CHECK(tree.way_m == stock.way_m);
  CHECK(tree.way_m.length() > 0.05);
}

TEST_CASE("A loop is left to Bullet's solver, which keeps it closed") {
  const Hung tied(ContactSolver::tree, false, true), stock(ContactSolver::stock, false, true);
  const Hung untied(ContactSolver::tree, false, false);
  CHECK(tied.way_m == stock.way_m);
  CHECK(tied.way_m.length() < 2e-3);
  CHECK(untied.way_m.length() > 0.05);
}

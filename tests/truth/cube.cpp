#include "cube.h"

#include <cmath>
#include <stdexcept>

#include <btBulletDynamicsCommon.h>

#include "kadans/model/kinematics.h"
#include "kadans/plant/bullet/bullet_world.h"
#include "parameter_reader.h"

namespace kadans::truth {
namespace {

struct GroundParameters {
  double friction = 0.2, restitution = 0.1, stiffness_N_per_m = 0, damping_Ns_per_m = 0;
};

GroundParameters ground_of(const Parameters& given) {
  GroundParameters ground;
  ParameterReader(given)
      .take("friction", ground.friction)
      .take("restitution", ground.restitution)
      .take("stiffness_N_per_m", ground.stiffness_N_per_m)
      .take("damping_Ns_per_m", ground.damping_Ns_per_m)
      .end();
  return ground;
}

class KadansCube final : public Cube {
 public:
  explicit KadansCube(const GroundParameters& ground) {
    Link link;
    link.name = "cube";
    link.inertia = {.mass_kg = mass_kg, .xx = inertia_kg_m2, .yy = inertia_kg_m2, .zz = inertia_kg_m2};
    link.collisions.push_back({"cube", "cube", {}, Box{{edge_m, edge_m, edge_m}}});
    model_.links.push_back(link);
    settings_.surfaces.push_back({"cube", 1.0});
    settings_.stand_on_ground = false;
    settings_.ground_friction = ground.friction;
    settings_.ground_restitution = ground.restitution;
    settings_.ground_stiffness_N_per_m = ground.stiffness_N_per_m;
    settings_.ground_damping_Ns_per_m = ground.damping_Ns_per_m;
  }

  void start(const Toss& toss) override {
    settings_.base = toss.frames.front();
    world_ = std::make_unique<BulletWorld>(model_, settings_, 1);
    // What the first step adds to the velocity: as if it had begun with it.
    const auto& v = toss.velocity_m_s;
    const double force = mass_kg / step_s;
    world_->push(0, {force * v[0], force * v[1], force * v[2]}, {});
    turn(toss);
  }
  void step() override { world_->step(std::llround(1e9 * step_s)); }
  Pose pose() const override { return world_->truth().base; }

 private:
  // A couple about each axis: two forces at arms of a metre.
  void turn(const Toss& toss) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vec3 arm_m{}, force_N{};
      arm_m[(axis + 1) % 3] = 1;
      force_N[(axis + 2) % 3] = inertia_kg_m2 * toss.angular_velocity_rad_s[axis] / step_s / 2;
      for (const double sign : {1.0, -1.0}) {
        const Vec3 at =
            rotate_inverse(toss.frames.front().orientation, {sign * arm_m[0], sign * arm_m[1], sign * arm_m[2]});
        world_->push(0, {sign * force_N[0], sign * force_N[1], sign * force_N[2]}, at);
      }
    }
  }

  RobotModel model_;
  PlantSettings settings_;
  std::unique_ptr<BulletWorld> world_;
};

class BulletCube final : public Cube {
 public:
  explicit BulletCube(const GroundParameters& ground)
      : shape_(btVector3(1, 1, 1) * edge_m / 2),
        body_(btRigidBody::btRigidBodyConstructionInfo(mass_kg, nullptr, &shape_, btVector3(1, 1, 1) * inertia_kg_m2)) {
    world_.setGravity({0, 0, -9.81});
    for (btRigidBody* body : {&ground_, &body_}) body->setFriction(std::sqrt(ground.friction));  // multiplied
    for (btRigidBody* body : {&ground_, &body_}) body->setRestitution(std::sqrt(ground.restitution));
    if (ground.stiffness_N_per_m > 0)
      ground_.setContactStiffnessAndDamping(ground.stiffness_N_per_m, ground.damping_Ns_per_m);
    world_.addRigidBody(&ground_);
    world_.addRigidBody(&body_);
  }
  ~BulletCube() override {
    world_.removeRigidBody(&body_);
    world_.removeRigidBody(&ground_);
  }

  void start(const Toss& toss) override {
    const Pose& pose = toss.frames.front();
    const Quat& q = pose.orientation;
    const auto vector = [](const Vec3& v) { return btVector3(v[0], v[1], v[2]); };
    const btTransform at(btQuaternion(q[1], q[2], q[3], q[0]), vector(pose.position_m));
    body_.setWorldTransform(at);
    body_.setInterpolationWorldTransform(at);
    body_.setLinearVelocity(vector(toss.velocity_m_s));
    body_.setAngularVelocity(vector(toss.angular_velocity_rad_s));
    body_.activate(true);
    world_.getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(body_.getBroadphaseProxy(), &dispatcher_);
    solver_.reset();
  }
  void step() override { world_.stepSimulation(step_s, 0); }
  Pose pose() const override {
    const btTransform& at = body_.getWorldTransform();
    const btQuaternion q = at.getRotation();
    return {{at.getOrigin().x(), at.getOrigin().y(), at.getOrigin().z()}, {q.w(), q.x(), q.y(), q.z()}};
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btStaticPlaneShape plane_{btVector3(0, 0, 1), 0};
  btRigidBody ground_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &plane_)};
  btBoxShape shape_;
  btRigidBody body_;
};

}  // namespace

std::unique_ptr<Cube> kadans_cube(const Parameters& parameters) {
  return std::make_unique<KadansCube>(ground_of(parameters));
}

std::unique_ptr<Cube> bullet_cube(const Parameters& parameters) {
  return std::make_unique<BulletCube>(ground_of(parameters));
}

std::vector<Pose> simulate(Cube& cube, const Toss& toss) {
  cube.start(toss);
  std::vector<Pose> frames{toss.frames.front()};
  while (frames.size() < toss.frames.size()) {
    for (int i = 0; i < steps_per_frame; ++i) cube.step();
    frames.push_back(cube.pose());
  }
  return frames;
}

std::vector<Errors> replay(Cube& cube, const std::vector<Toss>& tosses) {
  std::vector<Errors> each;
  for (const Toss& toss : tosses) each.push_back(errors_of(toss, simulate(cube, toss)));
  return each;
}

}  // namespace kadans::truth

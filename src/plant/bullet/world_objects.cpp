#include "world_objects.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "convert.h"
#include "plant/bullet/body.h"
#include "plant/bullet/contact/object_contact.h"
#include "plant/bullet/contact/room.h"
#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

// Of the shape's lowest point over a plane, whose normal is its z.
double over_ground_m(const btConvexShape& shape, const btTransform& pose, const btTransform& ground) {
  const btVector3 up = ground.getBasis().getColumn(2);
  const btVector3 lowest = pose * shape.localGetSupportingVertex(pose.getBasis().transpose() * -up);
  return up.dot(lowest - ground.getOrigin());
}

constexpr int ways = 8;  // away from a place in which there is no room

std::unique_ptr<btCompoundShape> compound_of(btConvexShape& shape) {
  auto compound = std::make_unique<btCompoundShape>(false);
  compound->addChildShape(btTransform::getIdentity(), &shape);
  return compound;
}

std::unique_ptr<btMultiBody> make_free_body(double mass_kg, const btVector3& moments_kg_m2, const Pose& pose,
                                            const Vec3& velocity_m_s) {
  auto body = make_multibody(0, mass_kg, moments_kg_m2, false);
  body->finalizeMultiDof();
  body->setBaseWorldTransform(to_bullet(pose));
  body->setBaseVel(to_bullet(velocity_m_s));
  return body;
}

btVector3 sphere_moments(double mass_kg, double radius_m) {
  const double moment = 0.4 * mass_kg * radius_m * radius_m;
  return {moment, moment, moment};
}

}  // namespace

WorldObjects::WorldObjects(const WorldSettings& settings) : settings_(settings) {
  objects_.reserve(settings.objects.size());
  for (const WorldObject& object : settings.objects) build(object);
}

void WorldObjects::build(const WorldObject& settings) {
  const int number = static_cast<int>(objects_.size());
  Object& object = objects_.emplace_back();
  object.settings = settings;
  if (const auto* ball = std::get_if<WorldBall>(&settings.shape)) {
    build_ball(object, *ball);
  } else if (const auto* pendulum = std::get_if<WorldPendulum>(&settings.shape)) {
    build_pendulum(object, *pendulum);
  } else if (settings.free()) {
    build_free_box(object, std::get<WorldBox>(settings.shape));
  } else {
    for (const SolidBox& box : solid_boxes(settings)) build_solid(object, box);
    object.start_m = object.parts[0].collider->getWorldTransform().getOrigin();
  }
  for (Part& part : object.parts) {
    part.collider->setUserIndex(number);
    part.collider->setFriction(settings.friction);
    part.collider->setRestitution(0);
  }
  if (const auto* ball = std::get_if<WorldBall>(&settings.shape)) {
    object.parts[0].collider->setRestitution(ball->restitution);
  }
}

void WorldObjects::build_solid(Object& object, const SolidBox& box) {
  Part part;
  part.shape = std::make_unique<btBoxShape>(to_bullet(box.size_m) / 2);
  part.compound = compound_of(*part.shape);
  const btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, part.compound.get());
  auto body = std::make_unique<btRigidBody>(info);
  body->setWorldTransform(to_bullet(box.pose));
  if (object.settings.motion.moves()) body->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  part.collider = std::move(body);
  object.parts.push_back(std::move(part));
}

void WorldObjects::build_free_box(Object& object, const WorldBox& box) {
  const auto [x, y, z] = box.size_m;
  const btVector3 moments = box.mass_kg / 12 * btVector3(y * y + z * z, x * x + z * z, x * x + y * y);
  object.multibody = make_free_body(box.mass_kg, moments, object.settings.pose, box.velocity_m_s);
  add_part(object, std::make_unique<btBoxShape>(to_bullet(box.size_m) / 2));
}

void WorldObjects::build_ball(Object& object, const WorldBall& ball) {
  object.multibody = make_free_body(ball.mass_kg, sphere_moments(ball.mass_kg, ball.radius_m), object.settings.pose,
                                    ball.velocity_m_s);
  add_part(object, std::make_unique<btSphereShape>(ball.radius_m));
  if (ball.rolling_friction_m > 0) object.rolling = std::make_unique<RollingRows>(*object.multibody);
}

// Turns about the pose's y axis: at a positive angle the bob is at negative x, behind.
void WorldObjects::build_pendulum(Object& object, const WorldPendulum& pendulum) {
  object.multibody = make_multibody(1, 1, {1, 1, 1}, true);
  const btVector3 hinge_to_bob(0, 0, -pendulum.length_m);
  object.multibody->setupRevolute(0, pendulum.mass_kg, sphere_moments(pendulum.mass_kg, pendulum.radius_m), -1,
                                  btQuaternion::getIdentity(), {0, 1, 0}, {0, 0, 0}, hinge_to_bob, false);
  object.multibody->finalizeMultiDof();
  object.multibody->setBaseWorldTransform(to_bullet(object.settings.pose) *
                                          btTransform(btQuaternion::getIdentity(), -hinge_to_bob));
  object.held_rad = std::asin(pendulum.distance_m / pendulum.length_m);
  object.release_s = pendulum.release_s;
  add_part(object, std::make_unique<btSphereShape>(pendulum.radius_m));
  hold(object);
}

void WorldObjects::add_part(Object& object, std::unique_ptr<btConvexShape> shape) {
  Part part;
  part.shape = std::move(shape);
  part.compound = compound_of(*part.shape);
  part.collider = make_collider(*object.multibody, object.multibody->getNumLinks() - 1, *part.compound);
  object.parts.push_back(std::move(part));
}

void WorldObjects::hold(Object& object) {
  object.multibody->setJointPos(0, object.held_rad);
  object.multibody->setJointVel(0, 0);
  object.multibody->forwardKinematics(scratch_rotations_, scratch_origins_);
  object.parts[0].collider->setWorldTransform(object.multibody->getLink(0).m_cachedWorldTransform);
}

void WorldObjects::add_to(ContactWorld& world) {
  for (Object& object : objects_) {
    if (object.multibody != nullptr) world.add(*object.multibody);
    for (Part& part : object.parts) world.add(*part.collider, object.multibody == nullptr);
    if (object.rolling != nullptr) world.add(*object.rolling);
  }
}

void WorldObjects::begin_step(std::span<ContactWorld* const> worlds, double time_s) {
  if (settings_.ground_motion.moves()) {
    const btVector3 velocity_m_s = to_bullet(velocity_at(settings_.ground_motion, time_s));
    for (ContactWorld* world : worlds) world->drive_ground(velocity_m_s);
  }
  for (Object& object : objects_) {
    if (object.multibody != nullptr || !object.settings.motion.moves()) continue;
    object.velocity_m_s = to_bullet(velocity_at(object.settings.motion, time_s));
    for (Part& part : object.parts) {
      worlds[0]->drive(*btRigidBody::upcast(part.collider.get()), object.velocity_m_s, object.settings.motion.conveyor);
    }
  }
}

void WorldObjects::end_step(const ContactWorld& world, double time_s) {
  for (Object& object : objects_) {
    if (object.rolling != nullptr) {
      const auto& ball = std::get<WorldBall>(object.settings.shape);
      object.rolling->set_limit(ball.rolling_friction_m * world.normal_impulse(*object.parts[0].collider));
    }
    if (object.multibody != nullptr && time_s <= object.release_s) hold(object);
  }
}

void WorldObjects::put(std::size_t number, const btVector3& position_m, std::span<ContactWorld* const> worlds) {
  if (number >= objects_.size()) throw std::invalid_argument("put: no object number " + std::to_string(number));
  Object& object = objects_[number];
  if (object.multibody == nullptr || object.multibody->getNumLinks() > 0)
    throw std::invalid_argument("put: '" + object.settings.name + "' is not free");
  if (!bullet::finite(position_m)) throw std::invalid_argument("put: the place must be finite");
  const btTransform asked(to_bullet(object.settings.pose).getBasis(), position_m);
  const double under_m = -over_ground_m(*object.parts[0].shape, asked, to_bullet(ground_pose(settings_)));
  if (under_m > start_depth_max_m)
    throw std::invalid_argument("put: '" + object.settings.name + "' would lie " + printed("%.0f", 1000 * under_m) +
                                " mm deep in the ground");
  btMultiBody& body = *object.multibody;
  const btTransform was = body.getBaseWorldTransform();
  const auto move = [&](const btTransform& to) {
    body.setBaseWorldTransform(to);
    object.parts[0].collider->setWorldTransform(to);
  };
  const auto put_down = [&](const btVector3& aside_m) {
    move(btTransform(asked.getBasis(), position_m + aside_m));
    return !is_crowded(body, worlds);
  };
  body.clearVelocities();
  if (put_down({0, 0, 0})) return;
  for (int ring = 1; ring * room_step_m <= room_max_m; ++ring) {
    for (int i = 0; i < ways; ++i) {
      const double rad = i * SIMD_2_PI / ways;
      if (put_down(ring * room_step_m * btVector3(std::cos(rad), std::sin(rad), 0))) return;
    }
  }
  move(was);
  throw std::invalid_argument(no_room("put"));
}

bool WorldObjects::finite(std::size_t object) const {
  const btMultiBody* body = objects_[object].multibody.get();
  if (body == nullptr) return true;
  double sum = body->getBasePos().dot(body->getBasePos());
  for (int i = 0; i < 6 + body->getNumDofs(); ++i) sum += body->getVelocityVector()[i];
  if (body->getNumLinks() > 0) sum += body->getJointPos(0);
  return std::isfinite(sum);
}

void WorldObjects::read(std::size_t number, ObjectTruth& truth) const {
  const Object& object = objects_[number];
  const btMultiBody* body = object.multibody.get();
  if (body == nullptr) {
    const btVector3 way = object.parts[0].collider->getWorldTransform().getOrigin() - object.start_m;
    truth.pose = object.settings.pose;
    truth.pose.position_m = from_bullet(to_bullet(object.settings.pose.position_m) + way);
    truth.velocity_m_s = from_bullet(object.velocity_m_s);
  } else if (body->getNumLinks() == 0) {
    truth.pose = from_bullet(body->getBaseWorldTransform());
    truth.velocity_m_s = from_bullet(body->getBaseVel());
    truth.angular_velocity_rad_s = from_bullet(body->getBaseOmega());
  } else {
    const btTransform bob = body->getLink(0).m_cachedWorldTransform;
    const btVector3 turn = body->getJointVel(0) * bob.getBasis().getColumn(1);
    truth.pose = from_bullet(bob);
    truth.angular_velocity_rad_s = from_bullet(turn);
    truth.velocity_m_s = from_bullet(turn.cross(bob.getOrigin() - body->getBasePos()));
  }
}

void WorldObjects::hash(StateHash& hash) const {
  for (const Object& object : objects_) {
    const btMultiBody* body = object.multibody.get();
    if (body == nullptr) {
      if (object.settings.motion.moves())
        hash.add(from_bullet(object.parts[0].collider->getWorldTransform().getOrigin()));
      continue;
    }
    hash.add(from_bullet(body->getBasePos()));
    hash.add(from_bullet(body->getWorldToBaseRot()));
    for (int i = 0; i < 6 + body->getNumDofs(); ++i) hash.add(body->getVelocityVector()[i]);
    if (body->getNumLinks() > 0) hash.add(body->getJointPos(0));
  }
}

}  // namespace kadans::bullet

// The objects of the world inside Bullet. A fixed or driven object has one static or kinematic body per box. An object
// that moves freely is a multibody of its own, so that the solver treats it like the robot: a ball or a box is a base
// without joints, a pendulum is one link on a fixed base. A driven body's velocity enters its contacts; at the end of a
// step the body is where this velocity leads.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "kadans/plant/world.h"
#include "kadans/plant/world_settings.h"
#include "plant/bullet/contact/contact_world.h"
#include "plant/bullet/contact/rolling_rows.h"

namespace kadans::bullet {

class WorldObjects {
 public:
  explicit WorldObjects(const WorldSettings& settings);

  void add_to(ContactWorld& world);
  // Velocities of all that is driven, for the step from time_s on: the first world's objects, each world's ground.
  void begin_step(std::span<ContactWorld* const> worlds, double time_s);
  void end_step(const ContactWorld& world, double time_s);

  // Puts a free object there, or where it has room beside what stands in these worlds, at rest. Throws
  // std::invalid_argument.
  void put(std::size_t object, const btVector3& position_m, std::span<ContactWorld* const> worlds);

  std::size_t size() const { return objects_.size(); }
  bool finite(std::size_t object) const;
  void read(std::size_t object, ObjectTruth& truth) const;
  void hash(StateHash& hash) const;

 private:
  struct Part {
    std::unique_ptr<btConvexShape> shape;
    std::unique_ptr<btCompoundShape> compound;
    std::unique_ptr<btCollisionObject> collider;
  };
  struct Object {
    WorldObject settings;
    std::vector<Part> parts;                 // the colliders
    btVector3 start_m{0, 0, 0};              // of a fixed or driven one: where its first part was
    btVector3 velocity_m_s{0, 0, 0};         // of a driven one; of a conveyor: of its surface
    std::unique_ptr<btMultiBody> multibody;  // of a free one
    std::unique_ptr<RollingRows> rolling;
    double held_rad = 0, release_s = 0;  // of a pendulum
  };

  void build(const WorldObject& settings);
  static void build_solid(Object& object, const SolidBox& box);
  static void build_free_box(Object& object, const WorldBox& box);
  static void build_ball(Object& object, const WorldBall& ball);
  void build_pendulum(Object& object, const WorldPendulum& pendulum);
  static void add_part(Object& object, std::unique_ptr<btConvexShape> shape);  // of a free one
  void hold(Object& object);

  WorldSettings settings_;
  std::vector<Object> objects_;
  btAlignedObjectArray<btQuaternion> scratch_rotations_;
  btAlignedObjectArray<btVector3> scratch_origins_;
};

}  // namespace kadans::bullet

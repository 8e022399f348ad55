// The robot inside Bullet: multibody, shapes and colliders of a RobotModel, and its state in the model's terms.
#pragma once

#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"
#include "plant/bullet/contact/contact_world.h"
#include "plant/bullet/contact/shapes.h"

namespace kadans::bullet {

// Where Bullet's frames lie in ours. Bullet moves each link's frame at the centre of mass, along its principal axes;
// the model uses link frames at the joints. This is the one place that knows both.
struct LinkFrame {
  btTransform com_in_link;
  btTransform link_in_com;
  btVector3 moments_kg_m2;
};

// A multibody of Bullet's without what is no physics: its damping, and its silent clamp of velocities.
std::unique_ptr<btMultiBody> make_multibody(int links, double mass_kg, const btVector3& moments_kg_m2, bool fixed);
// The collider of one of its links, -1 the base.
std::unique_ptr<btMultiBodyLinkCollider> make_collider(btMultiBody& body, int link, btCollisionShape& shape);

class Body {
 public:
  Body(const RobotModel& model, const PlantSettings& settings);

  void add_to(ContactWorld& world);
  // Puts every joint and the base where the settings say; with stand_on_ground the lowest point stands on what is under
  // it.
  void place(const PlantSettings& settings);

  // Puts the base over this place with this heading, tilt and joints as they are, at rest on what is under it.
  void carry(const WorldSettings& world, double x_m, double y_m, double heading_rad);

  btMultiBody& multibody() { return *multibody_; }
  const btMultiBody& multibody() const { return *multibody_; }
  std::size_t link_count() const { return frames_.size(); }
  // The count of what has mass: links and, after them, payloads.
  std::size_t mass_count() const { return static_cast<std::size_t>(multibody_->getNumLinks()) + 1; }
  double mass_kg(std::size_t link) const;
  // Gives the payloads the mass that they have at this time.
  void load(const std::vector<PayloadSettings>& payloads, double time_s);

  // As of the last step. Link 0 is the base; com_frame knows payloads too.
  btTransform com_frame(std::size_t link) const;
  btTransform link_frame(std::size_t link) const { return com_frame(link) * frames_[link].link_in_com; }

  void push(std::size_t link, const btVector3& force_N, const btVector3& point_in_link_m);

 private:
  void set_base(const btTransform& base);
  double over_surface_m(const WorldSettings& world) const;

  std::vector<LinkFrame> frames_;
  std::unique_ptr<btMultiBody> multibody_;
  std::vector<std::unique_ptr<LinkShapes>> shapes_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  btAlignedObjectArray<btQuaternion> scratch_rotations_;
  btAlignedObjectArray<btVector3> scratch_origins_;
};

using LinkPairs = std::vector<std::pair<std::size_t, std::size_t>>;

// Pairs that may collide and do, with the joints there. Leaves the body placed there.
LinkPairs touching_pairs(Body& body, const std::vector<double>& position_rad, PairMask& mask);

// Forbids parents with their children, and those of settings.passing.
PairMask known_pair_mask(const RobotModel& model, const PlantSettings& settings);
// Forbids all other pairs that touch while all joints are at 0, too. Leaves the body placed.
PairMask make_pair_mask(const RobotModel& model, const PlantSettings& settings, Body& body);

// What begins deep in something is thrown out of it in the first steps, at any speed.
inline constexpr double start_depth_max_m = 0.005;

// Throws std::invalid_argument when the robot starts deeper than that in the ground or in itself, with the pair, the
// depth and what may be done. Leaves the body placed.
void check_start(const RobotModel& model, const PlantSettings& settings, Body& body, PairMask& mask);

}  // namespace kadans::bullet

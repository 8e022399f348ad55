#include "body.h"

#include <algorithm>
#include <limits>

#include "convert.h"

namespace kadans::bullet {
namespace {

double friction_of(const RobotModel& model, const PlantSettings& settings, std::size_t link) {
  double friction = 0.5;
  for (const SurfaceSettings& surface : settings.surfaces) {
    if (model.find_link(surface.link) == link) friction = surface.friction;
  }
  return friction;
}

bool overlaps(const btPersistentManifold& manifold) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    if (manifold.getContactPoint(i).getDistance() <= 0) return true;
  }
  return false;
}

}  // namespace

Body::Body(const RobotModel& model, const PlantSettings& settings)
    : frames_(link_frames(model)), multibody_(make_multibody(model, frames_, settings)) {
  multibody_->setHasSelfCollision(settings.self_collision);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    shapes_.push_back(std::make_unique<LinkShapes>(model.links[i], frames_[i].com_in_link));
    if (shapes_.back()->empty()) continue;
    const int link = static_cast<int>(i) - 1;
    auto collider = std::make_unique<btMultiBodyLinkCollider>(multibody_.get(), link);
    collider->setCollisionShape(shapes_.back()->shape());
    collider->setFriction(friction_of(model, settings, i));
    collider->setRestitution(0);
    collider->setActivationState(DISABLE_DEACTIVATION);
    if (link < 0) {
      multibody_->setBaseCollider(collider.get());
    } else {
      multibody_->getLink(link).m_collider = collider.get();
    }
    colliders_.push_back(std::move(collider));
  }
}

void Body::add_to(ContactWorld& world) {
  world.add(*multibody_);
  for (auto& collider : colliders_) world.add(*collider, collider->m_link < 0 && multibody_->hasFixedBase());
}

void Body::place(const PlantSettings& settings) {
  for (std::size_t i = 0; i < settings.position_rad.size(); ++i) {
    multibody_->setJointPos(static_cast<int>(i), settings.position_rad[i]);
  }
  const btTransform base = to_bullet(settings.base);
  set_base(base);
  if (!settings.stand_on_ground || settings.fixed_base) return;
  const double over_m = over_surface_m(settings.world);
  if (over_m == std::numeric_limits<double>::infinity()) return;  // nothing that could stand
  set_base(btTransform(base.getBasis(), base.getOrigin() - btVector3(0, 0, over_m)));
}

void Body::set_base(const btTransform& base) {
  multibody_->setBaseWorldTransform(base * frames_[0].com_in_link);
  multibody_->forwardKinematics(scratch_rotations_, scratch_origins_);
}

// How far the robot can be let down; negative when it must be lifted.
double Body::over_surface_m(const WorldSettings& world) const {
  const bool flat = world.objects.empty() && world.slope_rad == 0;
  double over_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < link_count(); ++i) {
    if (flat) {
      over_m = std::min(over_m, shapes_[i]->lowest_m(com_frame(i)));
      continue;
    }
    for (const btVector3& corner : shapes_[i]->corners(com_frame(i))) {
      over_m = std::min(over_m, corner.z() - surface_height_m(world, corner.x(), corner.y()));
    }
  }
  return over_m;
}

void Body::load(const std::vector<PayloadSettings>& payloads, double time_s) {
  for (std::size_t i = 0; i < payloads.size(); ++i) {
    const bool carried = time_s >= payloads[i].from_s && time_s < payloads[i].until_s;
    multibody_->getLink(static_cast<int>(link_count() - 1 + i)).m_mass = carried ? payloads[i].mass_kg : 0;
  }
}

double Body::mass_kg(std::size_t link) const {
  return link == 0 ? multibody_->getBaseMass() : multibody_->getLinkMass(static_cast<int>(link) - 1);
}

btTransform Body::com_frame(std::size_t link) const {
  return link == 0 ? multibody_->getBaseWorldTransform()
                   : multibody_->getLink(static_cast<int>(link) - 1).m_cachedWorldTransform;
}

void Body::push(std::size_t link, const btVector3& force_N, const btVector3& point_in_link_m) {
  const btTransform com = com_frame(link);
  const btVector3 arm = com * (frames_[link].link_in_com * point_in_link_m) - com.getOrigin();
  if (link == 0) {
    multibody_->addBaseForce(force_N);
    multibody_->addBaseTorque(arm.cross(force_N));
  } else {
    multibody_->addLinkForce(static_cast<int>(link) - 1, force_N);
    multibody_->addLinkTorque(static_cast<int>(link) - 1, arm.cross(force_N));
  }
}

PairMask make_pair_mask(const RobotModel& model, const PlantSettings& settings) {
  PairMask mask(model.links.size());
  if (!settings.self_collision) {
    mask.forbid_all();
    return mask;
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) mask.forbid(model.joints[i].parent, i + 1);
  Body body(model, settings);
  ContactWorld world({.gravity_m_s2 = btVector3(0, 0, 0)}, mask);
  PlantSettings zero_pose;
  zero_pose.stand_on_ground = false;
  zero_pose.base.position_m = {0, 0, 100};  // clear of the ground
  body.place(zero_pose);
  body.add_to(world);
  world.detect_collisions();
  std::vector<std::pair<int, int>> touching;
  for (int i = 0; i < world.manifold_count(); ++i) {
    const btPersistentManifold& manifold = world.manifold(i);
    const auto* a = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    const auto* b = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    if (a != nullptr && b != nullptr && overlaps(manifold)) touching.emplace_back(a->m_link, b->m_link);
  }
  for (const auto& [a, b] : touching) mask.forbid(model_link(a), model_link(b));
  return mask;
}

}  // namespace kadans::bullet

#include "body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "convert.h"
#include "signal/number_text.h"

namespace kadans::bullet {
namespace {

double friction_of(const RobotModel& model, const PlantSettings& settings, std::size_t link) {
  double friction = 0.5;
  for (const SurfaceSettings& surface : settings.surfaces) {
    if (model.find_link(surface.link) == link) friction = surface.friction;
  }
  return friction;
}

// How deep the two bodies are in each other; negative when they only come near.
double depth_m(const btPersistentManifold& manifold) {
  double depth = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    depth = std::max<double>(depth, -manifold.getContactPoint(i).getDistance());
  }
  return depth;
}

// Two links, or one and the ground, that overlap.
struct Overlap {
  std::size_t link = 0;
  std::optional<std::size_t> other;  // nothing: the ground
  double depth_m = 0;
};

// What overlaps of pairs that may collide where the settings place the robot, the links of a fixed base left out.
std::vector<Overlap> overlaps_at(Body& body, const PlantSettings& settings, PairMask& mask) {
  body.place(settings);
  ContactWorld world(settings, mask);
  body.add_to(world);
  world.detect_collisions();
  std::vector<Overlap> found;
  for (int i = 0; i < world.manifold_count(); ++i) {
    const btPersistentManifold& manifold = world.manifold(i);
    const auto* a = btMultiBodyLinkCollider::upcast(manifold.getBody0());
    const auto* b = btMultiBodyLinkCollider::upcast(manifold.getBody1());
    Overlap overlap{.depth_m = depth_m(manifold)};
    if (overlap.depth_m < 0 || (a == nullptr && b == nullptr)) continue;
    overlap.link = model_link((a != nullptr ? a : b)->m_link);
    if (a != nullptr && b != nullptr) overlap.other = model_link(b->m_link);
    found.push_back(overlap);
  }
  return found;
}

// "l_knee at 2.1" for each joint between a link and the robot's base that is not at 0.
void tell_joints(const RobotModel& model, const PlantSettings& settings, std::size_t link, std::string& text) {
  for (; link != 0; link = model.joints[link - 1].parent) {
    const std::size_t joint = link - 1;
    const double position = joint < settings.position_rad.size() ? settings.position_rad[joint] : 0;
    const std::string& name = model.joints[joint].name;
    if (position == 0 || text.find("'" + name + "'") != std::string::npos) continue;
    text += (text.empty() ? "'" : ", '") + name + "' at " + printed("%.4g", position);
  }
}

void set_up_joint(btMultiBody& body, const RobotModel& model, const std::vector<LinkFrame>& frames, std::size_t index) {
  const Joint& joint = model.joints[index];
  const LinkFrame& parent = frames[joint.parent];
  const LinkFrame& child = frames[index + 1];
  const btTransform origin = to_bullet(joint.origin);
  const btQuaternion child_to_parent =
      parent.link_in_com.getRotation() * origin.getRotation() * child.com_in_link.getRotation();
  const btVector3 axis = to_bullet(joint.axis) * child.com_in_link.getBasis();
  const btVector3 parent_com_to_pivot = parent.link_in_com * origin.getOrigin();
  const btVector3 pivot_to_com = child.com_in_link.getOrigin() * child.com_in_link.getBasis();
  const double mass_kg = model.links[index + 1].inertia.mass_kg;
  const int link = static_cast<int>(index), parent_link = static_cast<int>(joint.parent) - 1;
  if (joint.type == JointType::prismatic) {
    body.setupPrismatic(link, mass_kg, child.moments_kg_m2, parent_link, child_to_parent.inverse(), axis,
                        parent_com_to_pivot, pivot_to_com, false);
  } else {
    body.setupRevolute(link, mass_kg, child.moments_kg_m2, parent_link, child_to_parent.inverse(), axis,
                       parent_com_to_pivot, pivot_to_com, false);
  }
}

void set_up_payload(btMultiBody& body, const RobotModel& model, const std::vector<LinkFrame>& frames,
                    const PayloadSettings& payload, int link) {
  const std::size_t carrier = model.find_link(payload.link).value();
  body.setupFixed(link, 0, {0, 0, 0}, static_cast<int>(carrier) - 1, btQuaternion::getIdentity(),
                  frames[carrier].link_in_com * to_bullet(payload.point_m), {0, 0, 0}, false);
}

// Bullet takes a link's inertia as three moments about axes that it expects to be the link's own. So each link gets a
// frame at its centre of mass along its principal axes. Jacobi rotations: exact to rounding, and identity for an
// inertia that is diagonal already.
struct PrincipalAxes {
  btMatrix3x3 rotation;  // columns: the axes, in the link's frame; right-handed
  btVector3 moments_kg_m2;
};

// One Jacobi rotation: makes a[p][q] zero and turns the axes with it.
void rotate_to_zero(btMatrix3x3& a, btMatrix3x3& axes, int p, int q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  btMatrix3x3 turn = btMatrix3x3::getIdentity();
  turn[p][p] = turn[q][q] = c;
  turn[p][q] = s;
  turn[q][p] = -s;
  a = turn.transpose() * a * turn;
  a[p][q] = a[q][p] = 0;
  axes = axes * turn;
}

PrincipalAxes principal_axes(const Inertia& inertia) {
  btMatrix3x3 a(inertia.xx, inertia.xy, inertia.xz,  //
                inertia.xy, inertia.yy, inertia.yz,  //
                inertia.xz, inertia.yz, inertia.zz);
  btMatrix3x3 axes = btMatrix3x3::getIdentity();
  constexpr int sweeps = 12;  // converges quadratically: 3 x 3 needs 4 or 5
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    rotate_to_zero(a, axes, 0, 1);
    rotate_to_zero(a, axes, 0, 2);
    rotate_to_zero(a, axes, 1, 2);
  }
  return {axes, btVector3(a[0][0], a[1][1], a[2][2])};
}

std::vector<LinkFrame> link_frames(const RobotModel& model) {
  std::vector<LinkFrame> frames;
  frames.reserve(model.links.size());
  for (const Link& link : model.links) {
    const PrincipalAxes axes = principal_axes(link.inertia);
    const btTransform com_in_link(axes.rotation, to_bullet(link.inertia.com_m));
    frames.push_back({com_in_link, com_in_link.inverse(), axes.moments_kg_m2});
  }
  return frames;
}

// A multibody with the model's links and joints, all joints at 0, its base at the world's origin. The payloads follow
// as links on fixed joints, without mass as yet.
std::unique_ptr<btMultiBody> make_robot(const RobotModel& model, const std::vector<LinkFrame>& frames,
                                        const PlantSettings& settings) {
  const int joints = static_cast<int>(model.joints.size()), payloads = static_cast<int>(settings.world.payloads.size());
  auto body =
      make_multibody(joints + payloads, model.links[0].inertia.mass_kg, frames[0].moments_kg_m2, settings.fixed_base);
  for (std::size_t i = 0; i < model.joints.size(); ++i) set_up_joint(*body, model, frames, i);
  for (int i = 0; i < payloads; ++i) {
    set_up_payload(*body, model, frames, settings.world.payloads[static_cast<std::size_t>(i)], joints + i);
  }
  body->finalizeMultiDof();
  return body;
}

}  // namespace

std::unique_ptr<btMultiBody> make_multibody(int links, double mass_kg, const btVector3& moments_kg_m2, bool fixed) {
  const bool can_sleep = false;
  auto body = std::make_unique<btMultiBody>(links, mass_kg, moments_kg_m2, fixed, can_sleep);
  body->setLinearDamping(0);  // 0.04 by default
  body->setAngularDamping(0);
  body->setMaxCoordinateVelocity(1e6);  // 100 by default
  return body;
}

std::unique_ptr<btMultiBodyLinkCollider> make_collider(btMultiBody& body, int link, btCollisionShape& shape) {
  auto collider = std::make_unique<btMultiBodyLinkCollider>(&body, link);
  collider->setCollisionShape(&shape);
  collider->setActivationState(DISABLE_DEACTIVATION);
  if (link < 0) {
    body.setBaseCollider(collider.get());
  } else {
    body.getLink(link).m_collider = collider.get();
  }
  return collider;
}

Body::Body(const RobotModel& model, const PlantSettings& settings)
    : frames_(link_frames(model)), multibody_(make_robot(model, frames_, settings)) {
  multibody_->setHasSelfCollision(settings.self_collision);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    shapes_.push_back(std::make_unique<LinkShapes>(model.links[i], frames_[i].com_in_link));
    if (shapes_.back()->empty()) continue;
    colliders_.push_back(make_collider(*multibody_, static_cast<int>(i) - 1, *shapes_.back()->shape()));
    colliders_.back()->setFriction(friction_of(model, settings, i));
    colliders_.back()->setRestitution(0);
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

void Body::carry(const WorldSettings& world, double x_m, double y_m, double heading_rad) {
  const btTransform base = link_frame(0);
  const double turn_rad = heading_rad - heading_of(base.getBasis());
  const btMatrix3x3 turned = btMatrix3x3(btQuaternion({0, 0, 1}, turn_rad)) * base.getBasis();
  multibody_->clearVelocities();
  set_base(btTransform(turned, {x_m, y_m, base.getOrigin().z()}));
  const double over_m = over_surface_m(world);
  if (over_m != std::numeric_limits<double>::infinity())
    set_base(btTransform(turned, {x_m, y_m, base.getOrigin().z() - over_m}));
  for (auto& collider : colliders_)
    collider->setWorldTransform(collider->m_link < 0 ? multibody_->getBaseWorldTransform()
                                                     : multibody_->getLink(collider->m_link).m_cachedWorldTransform);
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

LinkPairs touching_pairs(Body& body, const std::vector<double>& position_rad, PairMask& mask) {
  PlantSettings clear_of_ground;
  clear_of_ground.stand_on_ground = false;
  clear_of_ground.base.position_m = {0, 0, 100};
  clear_of_ground.position_rad = position_rad;
  LinkPairs pairs;
  for (const Overlap& overlap : overlaps_at(body, clear_of_ground, mask)) {
    if (overlap.other) pairs.emplace_back(overlap.link, *overlap.other);
  }
  return pairs;
}

PairMask known_pair_mask(const RobotModel& model, const PlantSettings& settings) {
  PairMask mask(model.links.size());
  if (!settings.self_collision) mask.forbid_all();
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    std::size_t carrier = model.joints[i].parent;
    mask.forbid(carrier, i + 1);
    while (carrier > 0 && model.links[carrier].inertia.mass_kg == 0) {  // it joins two links, and is none itself
      carrier = model.joints[carrier - 1].parent;
      mask.forbid(carrier, i + 1);
    }
  }
  for (const auto& [first, second] : settings.passing) {
    const auto a = model.find_link(first), b = model.find_link(second);
    if (a && b) mask.forbid(*a, *b);
  }
  return mask;
}

PairMask make_pair_mask(const RobotModel& model, const PlantSettings& settings, Body& body) {
  PairMask mask = known_pair_mask(model, settings);
  if (!settings.self_collision) return mask;
  for (const auto& [a, b] : touching_pairs(body, std::vector<double>(model.joints.size()), mask)) mask.forbid(a, b);
  return mask;
}

void check_start(const RobotModel& model, const PlantSettings& settings, Body& body, PairMask& mask) {
  Overlap worst{.depth_m = start_depth_max_m};
  for (const Overlap& overlap : overlaps_at(body, settings, mask)) {
    if (overlap.depth_m > worst.depth_m) worst = overlap;
  }
  if (!(worst.depth_m > start_depth_max_m)) return;
  std::string joints;
  tell_joints(model, settings, worst.link, joints);
  if (worst.other) tell_joints(model, settings, *worst.other, joints);
  const std::string with = joints.empty() ? " with all its joints at 0" : " with " + joints;
  const std::string link =
      "link '" + model.links[worst.link].name + "' is " + printed("%.0f", 1000 * worst.depth_m) + " mm deep in ";
  if (worst.other) {
    throw std::invalid_argument("start: " + link + "link '" + model.links[*worst.other].name + "'" + with +
                                "; start in another pose, or let the two pass through each other (collisions)");
  }
  throw std::invalid_argument("start: " + link + "the ground" + with + " and the base at a height of " +
                              printed("%.3g", settings.base.position_m[2]) + " m; " +
                              (settings.fixed_base
                                   ? "a fixed base stays where it is put: start higher (start.position_m)"
                                   : "start higher, or with stand_on_ground"));
}

}  // namespace kadans::bullet

#include "body_frames.h"

#include "convert.h"
#include "principal_axes.h"

namespace kadans::bullet {
namespace {

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

}  // namespace

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

std::unique_ptr<btMultiBody> make_multibody(const RobotModel& model, const std::vector<LinkFrame>& frames,
                                            const PlantSettings& settings) {
  const bool can_sleep = false;
  const int joints = static_cast<int>(model.joints.size()), payloads = static_cast<int>(settings.world.payloads.size());
  auto body = std::make_unique<btMultiBody>(joints + payloads, model.links[0].inertia.mass_kg, frames[0].moments_kg_m2,
                                            settings.fixed_base, can_sleep);
  for (std::size_t i = 0; i < model.joints.size(); ++i) set_up_joint(*body, model, frames, i);
  for (int i = 0; i < payloads; ++i) {
    set_up_payload(*body, model, frames, settings.world.payloads[static_cast<std::size_t>(i)], joints + i);
  }
  body->finalizeMultiDof();
  body->setLinearDamping(0);  // 0.04 by default: not physics
  body->setAngularDamping(0);
  body->setMaxCoordinateVelocity(1e6);  // 100 by default, a silent clamp
  return body;
}

}  // namespace kadans::bullet

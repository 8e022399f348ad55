#include "kadans/model/urdf_frames.h"

#include "kadans/model/kinematics.h"
#include "kadans/signal/input_error.h"
#include "urdf_dom.h"

namespace kadans {

std::vector<UrdfFrame> urdf_frames(const RobotModel& model, const std::string& text) {
  const UrdfDom dom = parse_with_urdfdom(text);
  if (!dom.model) throw InputError({.file = model.file, .message = dom.complaints.front()});
  std::vector<UrdfFrame> frames;
  for (const auto& [name, joint] : dom.model->joints_) {
    const urdf::Vector3& at = joint->parent_to_joint_origin_transform.position;
    const urdf::Rotation& turned = joint->parent_to_joint_origin_transform.rotation;
    frames.push_back({.parent = joint->parent_link_name,
                      .child = joint->child_link_name,
                      .joint = model.find_joint(name),
                      .origin = {{at.x, at.y, at.z}, normalized({turned.w, turned.x, turned.y, turned.z})}});
  }
  return frames;
}

Pose frame_pose(const UrdfFrame& frame, const RobotModel& model, std::span<const double> position_rad) noexcept {
  if (!frame.joint) return frame.origin;
  const Joint& joint = model.joints[*frame.joint];
  const double position = position_rad[*frame.joint];
  if (joint.type != JointType::prismatic)
    return compose(frame.origin, {{0, 0, 0}, from_axis_angle(joint.axis, position)});
  const Vec3& axis = joint.axis;
  return compose(frame.origin, {{axis[0] * position, axis[1] * position, axis[2] * position}, {1, 0, 0, 0}});
}

}  // namespace kadans

#include "kadans/control/limb_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace kadans {
namespace {

Pose motion(const LimbChain::Segment& segment, double position) noexcept {
  const Vec3& axis = segment.axis;
  if (!segment.prismatic) return {{}, from_axis_angle(axis, position)};
  return {{axis[0] * position, axis[1] * position, axis[2] * position}, {1, 0, 0, 0}};
}

}  // namespace

LimbChain::LimbChain(const RobotModel& model, std::size_t link) {
  for (std::size_t i = link; i > 0; i = model.joints[i - 1].parent) {
    const Joint& joint = model.joints[i - 1];
    segments_.push_back(
        {.joint = i - 1, .prismatic = joint.type == JointType::prismatic, .origin = joint.origin, .axis = joint.axis});
    if (joint.parent > 0) reach_m_ += length(joint.origin.position_m);
    if (segments_.back().prismatic) reach_m_ += std::max(std::abs(joint.lower_rad), std::abs(joint.upper_rad));
  }
  if (segments_.empty())
    throw std::invalid_argument("link " + model.links.at(link).name + " is the base: no joint moves it");
  std::reverse(segments_.begin(), segments_.end());
  places_.resize(segments_.size());
}

Vec3 LimbChain::update(const JointStates& joints, const Vec3& point_in_link_m) noexcept {
  Pose pose;
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& segment = segments_[i];
    pose = compose(pose, segment.origin);
    pose = compose(pose, motion(segment, joints.joints[segment.joint].position_rad));
    places_[i] = {pose.position_m, rotate(pose.orientation, segment.axis)};
  }
  const Vec3 point = transform(pose, point_in_link_m);
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Vec3& from = places_[i].position_m;
    const Vec3 arm{point[0] - from[0], point[1] - from[1], point[2] - from[2]};
    segments_[i].column_m_per_rad = segments_[i].prismatic ? places_[i].axis : cross(places_[i].axis, arm);
  }
  return point;
}

}  // namespace kadans

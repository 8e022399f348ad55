#include "kadans/estimate/leg_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

Vec3 along(const Axes& axes, const Vec3& v) noexcept {
  Vec3 sum;
  for (std::size_t i = 0; i < 3; ++i) sum[i] = axes.x[i] * v[0] + axes.y[i] * v[1] + axes.z[i] * v[2];
  return sum;
}

Axes along(const Axes& outer, const Axes& inner) noexcept {
  return {along(outer, inner.x), along(outer, inner.y), along(outer, inner.z)};
}

// Turns a and b by the angle in their plane, from a towards b.
void turn_pair(Vec3& a, Vec3& b, double cosine, double sine) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    const double old_a = a[i];
    a[i] = cosine * old_a + sine * b[i];
    b[i] = cosine * b[i] - sine * old_a;
  }
}

// Rodrigues' formula.
Axes turned_about(const Vec3& u, double cosine, double sine) noexcept {
  const double v = 1 - cosine;
  return {{u[0] * u[0] * v + cosine, u[0] * u[1] * v + u[2] * sine, u[0] * u[2] * v - u[1] * sine},
          {u[0] * u[1] * v - u[2] * sine, u[1] * u[1] * v + cosine, u[1] * u[2] * v + u[0] * sine},
          {u[0] * u[2] * v + u[1] * sine, u[1] * u[2] * v - u[0] * sine, u[2] * u[2] * v + cosine}};
}

}  // namespace

Axes axes_of(const Quat& q) noexcept {
  const auto [w, x, y, z] = q;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

LegChain::LegChain(const RobotModel& model, std::size_t link) {
  if (link >= model.links.size()) throw std::invalid_argument("the robot has no link " + std::to_string(link));
  for (; link > 0; link = model.joints[link - 1].parent) {
    const Joint& joint = model.joints[link - 1];
    Segment segment;
    segment.joint = link - 1;
    segment.prismatic = joint.type == JointType::prismatic;
    segment.origin_turned = std::fabs(joint.origin.orientation[0]) != 1;
    segment.origin_m = joint.origin.position_m;
    segment.origin_axes = axes_of(joint.origin.orientation);
    segment.axis = joint.axis;
    segment.main_axis = -1;
    for (std::size_t i = 0; i < 3; ++i)
      if (std::fabs(joint.axis[i]) == 1) {
        segment.main_axis = static_cast<int>(i);
        segment.sign = joint.axis[i];
      }
    segments_.push_back(segment);
  }
  std::reverse(segments_.begin(), segments_.end());
}

void LegChain::turn(const Segment& segment, double angle_rad) noexcept {
  const double cosine = std::cos(angle_rad);
  const double sine = std::sin(angle_rad);
  switch (segment.main_axis) {
    case 0:
      return turn_pair(axes_.y, axes_.z, cosine, segment.sign * sine);
    case 1:
      return turn_pair(axes_.z, axes_.x, cosine, segment.sign * sine);
    case 2:
      return turn_pair(axes_.x, axes_.y, cosine, segment.sign * sine);
    default:
      axes_ = along(axes_, turned_about(segment.axis, cosine, sine));
  }
}

Vec3 LegChain::point(const Vec3& in_link_m) const noexcept {
  const Vec3 arm = along(axes_, in_link_m);
  return {position_m_[0] + arm[0], position_m_[1] + arm[1], position_m_[2] + arm[2]};
}

void LegChain::update(const JointStates& joints, const Axes& base) noexcept {
  axes_ = base;
  position_m_ = {};
  for (const Segment& segment : segments_) {
    const double position = joints.joints[segment.joint].position_rad;
    position_m_ = point(segment.origin_m);
    if (segment.origin_turned) axes_ = along(axes_, segment.origin_axes);
    if (segment.prismatic)
      position_m_ = point({segment.axis[0] * position, segment.axis[1] * position, segment.axis[2] * position});
    else
      turn(segment, position);
  }
}

}  // namespace kadans

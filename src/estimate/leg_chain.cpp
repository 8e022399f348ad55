
#include "leg_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "signal/sine_cosine.h"

namespace kadans {

Attitude attitude(const Axes& axes) noexcept {
  const auto& [x, y, z] = axes;
  const double level = std::sqrt(x[0] * x[0] + x[1] * x[1]);
  const double pitch_rad = std::atan2(-x[2], level);
  const double tilt_rad = std::atan2(std::sqrt(z[0] * z[0] + z[1] * z[1]), z[2]);
  // x points straight up or down: only yaw - roll, or yaw + roll, is defined.
  if (level < 1e-12) return {0, pitch_rad, std::atan2(-y[0], y[1]), tilt_rad};
  return {std::atan2(y[2], z[2]), pitch_rad, std::atan2(x[1], x[0]), tilt_rad};
}

Posture posture_of(const Vec3& up) noexcept {
  constexpr double lying = 0.6;
  if (up[2] > lying) return Posture::upright;
  if (up[0] < -lying) return Posture::prone;
  if (up[0] > lying) return Posture::supine;
  return up[1] < 0 ? Posture::left : Posture::right;
}

namespace {

// Turns a and b by the angle in their plane, from a towards b.
[[gnu::always_inline]] inline void turn_pair(Vec3& a, Vec3& b, double cosine, double sine) noexcept {
  const double a0 = a[0], a1 = a[1], a2 = a[2];
  a[0] = cosine * a0 + sine * b[0];
  a[1] = cosine * a1 + sine * b[1];
  a[2] = cosine * a2 + sine * b[2];
  b[0] = cosine * b[0] - sine * a0;
  b[1] = cosine * b[1] - sine * a1;
  b[2] = cosine * b[2] - sine * a2;
}

// Rodrigues' formula.
Axes turned_about(const Vec3& u, double cosine, double sine) noexcept {
  const double v = 1 - cosine;
  return {{u[0] * u[0] * v + cosine, u[0] * u[1] * v + u[2] * sine, u[0] * u[2] * v - u[1] * sine},
          {u[0] * u[1] * v - u[2] * sine, u[1] * u[1] * v + cosine, u[1] * u[2] * v + u[0] * sine},
          {u[0] * u[2] * v + u[1] * sine, u[1] * u[2] * v - u[0] * sine, u[2] * u[2] * v + cosine}};
}

}  // namespace

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

// Local copies: the compiler keeps them in registers.
void LegChain::update(const JointStates& joints, const Axes& base) noexcept {
  Axes axes = base;
  Vec3 place_m{};
  for (const Segment& segment : segments_) {
    const double position = joints.joints[segment.joint].position_rad;
    place_m = sum(place_m, along(axes, segment.origin_m));
    if (segment.origin_turned) axes = along(axes, segment.origin_axes);
    if (segment.prismatic) {
      const Vec3& axis = segment.axis;
      place_m = sum(place_m, along(axes, Vec3{axis[0] * position, axis[1] * position, axis[2] * position}));
      continue;
    }
    const auto [sine, cosine] = sine_cosine(position);
    switch (segment.main_axis) {
      case 0:
        turn_pair(axes.y, axes.z, cosine, segment.sign * sine);
        break;
      case 1:
        turn_pair(axes.z, axes.x, cosine, segment.sign * sine);
        break;
      case 2:
        turn_pair(axes.x, axes.y, cosine, segment.sign * sine);
        break;
      default:
        axes = along(axes, turned_about(segment.axis, cosine, sine));
    }
  }
  axes_ = axes;
  position_m_ = place_m;
}

}  // namespace kadans

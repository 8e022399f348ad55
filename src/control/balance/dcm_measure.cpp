#include "dcm_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "control/option_link.h"

namespace kadans {
std::array<std::size_t, 2> two_feet(const ObjectSetup& setup) {
  return {required_link(setup, "left_foot", "a foot's link"), required_link(setup, "right_foot", "a foot's link")};
}

void MovingBody::update(const ControlInput& input, const Quat& upright) noexcept {
  const std::size_t count = model_->joints.size();
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < count; ++i) position_rad[i] = input.joints.joints[i].position_rad;
  kinematics_.update({position_rad.data(), count}, {{}, upright});
  links_[0] = {{}, rotate(upright, input.status.base.angular_velocity_rad_s)};
  for (std::size_t i = 0; i < count; ++i) {
    const Joint& joint = model_->joints[i];
    const Velocity& parent = links_[joint.parent];
    const Pose& link = kinematics_.link(i + 1);
    const Vec3 arm_m = difference(link.position_m, kinematics_.link(joint.parent).position_m);
    const Vec3 own = scaled(input.joints.joints[i].velocity_rad_s, rotate(link.orientation, joint.axis));
    Velocity& child = links_[i + 1];
    child = {sum(parent.linear_m_s, cross(parent.angular_rad_s, arm_m)), parent.angular_rad_s};
    Vec3& moved = joint.type == JointType::prismatic ? child.linear_m_s : child.angular_rad_s;
    moved = sum(moved, own);
  }
  add_up();
}

void MovingBody::add_up() noexcept {
  Vec3 moment{}, momentum{};
  double mass_kg = 0;
  for (std::size_t i = 0; i < model_->links.size(); ++i) {
    const Inertia& inertia = model_->links[i].inertia;
    const Vec3 point_m = transform(kinematics_.link(i), inertia.com_m);
    moment = sum(moment, scaled(inertia.mass_kg, point_m));
    momentum = sum(momentum, scaled(inertia.mass_kg, velocity_m_s(i, point_m)));
    mass_kg += inertia.mass_kg;
  }
  const double share = mass_kg > 0 ? 1 / mass_kg : 0;
  com_m_ = scaled(share, moment);
  com_velocity_m_s_ = scaled(share, momentum);
}

Vec3 MovingBody::velocity_m_s(std::size_t link, const Vec3& point_m) const noexcept {
  const Velocity& of = links_[link];
  return sum(of.linear_m_s, cross(of.angular_rad_s, difference(point_m, kinematics_.link(link).position_m)));
}

bool Standing::update(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  body_.update(input, from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0));
  const Kinematics& links = body_.kinematics();
  const Vec3 between_m = scaled(0.5, sum(links.link(feet_[0]).position_m, links.link(feet_[1]).position_m));
  const Vec3 between_m_s = scaled(0.5, sum(body_.velocity_m_s(feet_[0]), body_.velocity_m_s(feet_[1])));
  com_m_ = difference(body_.com_m(), between_m);
  velocity_m_s_ = difference(body_.com_velocity_m_s(), between_m_s);
  const double time_s = std::sqrt(std::max(com_m_[2], lowest_com_m) / gravity_of_balance_m_s2);
  dcm_x_m_ = com_m_[0] + time_s * velocity_m_s_[0];
  dcm_y_m_ = com_m_[1] + time_s * velocity_m_s_[1];
  return com_m_[2] > lowest_com_m && std::isfinite(dcm_x_m_) && std::isfinite(dcm_y_m_);
}

double DcmMeasure::dcm(std::size_t axis, const OverFoot& over) const noexcept {
  return over.com_m[axis] + over.velocity_m_s[axis] / rate_per_s_;
}

bool DcmMeasure::update(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  yaw_rad_ = keeps_ ? std::remainder(base.yaw_rad - heading_rad_, 2 * std::numbers::pi) : 0;
  upright_ = from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, yaw_rad_);
  body_.update(input, upright_);
  for (std::size_t i = 0; i < 2; ++i) {
    OverFoot& over = over_[i];
    const Pose& foot = body_.kinematics().link(feet_[i]);
    over.foot_m = foot.position_m;
    const Vec3 toes = rotate(foot.orientation, {1, 0, 0});
    over.toe_up_m = toes[2];
    over.left_up_m = rotate(foot.orientation, {0, 1, 0})[2];
    over.yaw_rad = std::atan2(toes[1], toes[0]);
    over.com_m = difference(body_.com_m(), over.foot_m);
    over.velocity_m_s = difference(body_.com_velocity_m_s(), body_.velocity_m_s(feet_[i]));
  }
  const double height_m = (over_[0].com_m[2] + over_[1].com_m[2]) / 2;
  rate_per_s_ = std::sqrt(gravity_of_balance_m_s2 / std::max(height_m, lowest_com_m));
  bool finite = true;
  for (OverFoot& over : over_) {
    over.dcm_x_m = dcm(0, over);
    over.dcm_y_m = dcm(1, over);
    finite = finite && std::isfinite(over.dcm_x_m) && std::isfinite(over.dcm_y_m);
  }
  return height_m > lowest_com_m && finite;
}

void DcmMeasure::keep_heading(const ControlInput& input) noexcept {
  keeps_ = true;
  heading_rad_ = input.status.base.yaw_rad;
}

}  // namespace kadans

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

void BodyAhead::update(const ControlInput& input, const Quat& upright, double ahead_s) noexcept {
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointState& joint = input.joints.joints[i];
    position_rad[i] = joint.position_rad + ahead_s * joint.velocity_rad_s;
  }
  const Vec3& w = input.status.base.angular_velocity_rad_s;
  const Quat turn = normalized({1, 0.5 * ahead_s * w[0], 0.5 * ahead_s * w[1], 0.5 * ahead_s * w[2]});
  kinematics_.update({position_rad.data(), joint_count_}, {{}, multiply(upright, turn)});
}

Vec3 Standing::com_over_feet(const ControlInput& input, double ahead_s) noexcept {
  const BaseStatus& base = input.status.base;
  body_.update(input, from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0), ahead_s);
  const Vec3 com = body_.kinematics().com_m();
  const Vec3& left = body_.kinematics().link(feet_[0]).position_m;
  const Vec3& right = body_.kinematics().link(feet_[1]).position_m;
  return {com[0] - (left[0] + right[0]) / 2, com[1] - (left[1] + right[1]) / 2, com[2] - (left[2] + right[2]) / 2};
}

bool Standing::update(const ControlInput& input) noexcept {
  const Vec3 next = com_over_feet(input, moment_s);
  com_m_ = com_over_feet(input, 0);
  for (std::size_t k = 0; k < 3; ++k) velocity_m_s_[k] = (next[k] - com_m_[k]) / moment_s;
  const double time_s = std::sqrt(std::max(com_m_[2], lowest_com_m) / gravity_of_balance_m_s2);
  dcm_x_m_ = com_m_[0] + time_s * velocity_m_s_[0];
  dcm_y_m_ = com_m_[1] + time_s * velocity_m_s_[1];
  return com_m_[2] > lowest_com_m && std::isfinite(dcm_x_m_) && std::isfinite(dcm_y_m_);
}

namespace {

Vec3 difference(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

}  // namespace

double DcmMeasure::dcm(std::size_t axis, const OverFoot& over) const noexcept {
  return over.com_m[axis] + over.velocity_m_s[axis] / rate_per_s_;
}

bool DcmMeasure::update(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  yaw_rad_ = keeps_ ? std::remainder(base.yaw_rad - heading_rad_, 2 * std::numbers::pi) : 0;
  upright_ = from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, yaw_rad_);
  std::array<Vec3, 2> next_m{};
  body_.update(input, upright_, moment_s);
  for (std::size_t i = 0; i < 2; ++i)
    next_m[i] = difference(body_.kinematics().com_m(), body_.kinematics().link(feet_[i]).position_m);
  body_.update(input, upright_, 0);
  com_m_ = body_.kinematics().com_m();
  for (std::size_t i = 0; i < 2; ++i) {
    OverFoot& over = over_[i];
    const Pose& foot = body_.kinematics().link(feet_[i]);
    over.foot_m = foot.position_m;
    const Vec3 toes = rotate(foot.orientation, {1, 0, 0});
    over.toe_up_m = toes[2];
    over.left_up_m = rotate(foot.orientation, {0, 1, 0})[2];
    over.yaw_rad = std::atan2(toes[1], toes[0]);
    over.com_m = difference(com_m_, over.foot_m);
    const Vec3 way_m = difference(next_m[i], over.com_m);
    over.velocity_m_s = {way_m[0] / moment_s, way_m[1] / moment_s, way_m[2] / moment_s};
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

#include "kadans/control/dcm_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

constexpr double moved_on_s = 0.001;
constexpr double fallen_com_m = 0.1;  // below, it does not stand

std::size_t foot_link(const ObjectSetup& setup, const char* option) {
  const std::string* const name = setup.options.find(option);
  if (name == nullptr) throw OptionError(option, "it needs the option '" + std::string(option) + "': a foot's link");
  const auto link = setup.model.find_link(*name);
  if (!link)
    throw OptionError(option, "there is no link '" + *name + "'" + did_you_mean(*name, setup.model.link_names()));
  return *link;
}

Vec3 difference(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

}  // namespace

DcmMeasure::DcmMeasure(const ObjectSetup& setup)
    : kinematics_(setup.model),
      joint_count_(setup.model.joints.size()),
      feet_{foot_link(setup, "left_foot"), foot_link(setup, "right_foot")} {}

void DcmMeasure::place(const ControlInput& input, double ahead_s) noexcept {
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const JointState& joint = input.joints.joints[i];
    position_rad[i] = joint.position_rad + ahead_s * joint.velocity_rad_s;
  }
  const Vec3& w = input.status.base.angular_velocity_rad_s;
  const Quat turn = normalized({1, 0.5 * ahead_s * w[0], 0.5 * ahead_s * w[1], 0.5 * ahead_s * w[2]});
  kinematics_.update({position_rad.data(), joint_count_}, {{}, multiply(upright_, turn)});
}

double DcmMeasure::dcm(std::size_t axis, const OverFoot& over) const noexcept {
  return over.com_m[axis] + over.velocity_m_s[axis] / rate_per_s_;
}

bool DcmMeasure::update(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  yaw_rad_ = keeps_ ? std::remainder(base.yaw_rad - heading_rad_, 2 * std::numbers::pi) : 0;
  upright_ = from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, yaw_rad_);
  std::array<Vec3, 2> next_m{};
  place(input, moved_on_s);
  for (std::size_t i = 0; i < 2; ++i)
    next_m[i] = difference(kinematics_.com_m(), kinematics_.link(feet_[i]).position_m);
  place(input, 0);
  com_m_ = kinematics_.com_m();
  for (std::size_t i = 0; i < 2; ++i) {
    OverFoot& over = over_[i];
    over.foot_m = kinematics_.link(feet_[i]).position_m;
    over.toe_up_m = rotate(kinematics_.link(feet_[i]).orientation, {1, 0, 0})[2];
    over.com_m = difference(com_m_, over.foot_m);
    const Vec3 way_m = difference(next_m[i], over.com_m);
    over.velocity_m_s = {way_m[0] / moved_on_s, way_m[1] / moved_on_s, way_m[2] / moved_on_s};
  }
  const double height_m = (over_[0].com_m[2] + over_[1].com_m[2]) / 2;
  rate_per_s_ = std::sqrt(dcm_gravity_m_s2 / std::max(height_m, fallen_com_m));
  bool finite = true;
  for (OverFoot& over : over_) {
    over.dcm_x_m = dcm(0, over);
    over.dcm_y_m = dcm(1, over);
    finite = finite && std::isfinite(over.dcm_x_m) && std::isfinite(over.dcm_y_m);
  }
  return height_m > fallen_com_m && finite;
}

void DcmMeasure::keep_heading(const ControlInput& input) noexcept {
  keeps_ = true;
  heading_rad_ = input.status.base.yaw_rad;
}

}  // namespace kadans

#include "dcm_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans {
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
  for (std::size_t i = 0; i < 2; ++i) next_m[i] = difference(body_.kinematics().com_m(), body_.foot(i).position_m);
  body_.update(input, upright_, 0);
  com_m_ = body_.kinematics().com_m();
  for (std::size_t i = 0; i < 2; ++i) {
    OverFoot& over = over_[i];
    over.foot_m = body_.foot(i).position_m;
    over.toe_up_m = rotate(body_.foot(i).orientation, {1, 0, 0})[2];
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

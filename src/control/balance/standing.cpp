#include "standing.h"

#include <algorithm>
#include <cmath>

namespace kadans {

Vec3 Standing::com_over_feet(const ControlInput& input, double ahead_s) noexcept {
  const BaseStatus& base = input.status.base;
  body_.update(input, from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0), ahead_s);
  const Vec3 com = body_.kinematics().com_m();
  const Vec3& left = body_.foot(0).position_m;
  const Vec3& right = body_.foot(1).position_m;
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

}  // namespace kadans

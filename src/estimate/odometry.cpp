#include "odometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans {

void Odometry::update(const Way& way, bool all, const std::array<double, 2>& heading, const BaseStatus& base,
                      double dt_s, OdometryStatus& status) noexcept {
  lifted_s_ = way.feet > 0 ? 0 : lifted_s_ + dt_s;
  learn_drift(way, all, base.angular_velocity_rad_s, dt_s);
  const bool stands = lifted_s_ < lifted_s && base.posture == Posture::upright, was_valid = state_.valid;
  if (resets_) {
    resets_ = false;
    go(way, base.yaw_rad);
    begin_path();
    state_ = {.resets = state_.resets + 1, .valid = stands, .breaks = state_.breaks};
    zero_rad_ = base.yaw_rad;
    zero_x_ = heading[0];
    zero_y_ = heading[1];
  } else {
    state_.valid = state_.valid && stands;
    go(way, base.yaw_rad);
  }
  if (state_.valid != was_valid) ++state_.breaks;
  go_along_path();
  status = state_;
}

// What was counted so far lies behind: the path goes on from there.
void Odometry::begin_path() noexcept {
  go_along_path();
  path_ = {state_.path_x_m, state_.path_y_m, state_.path_heading_rad};
  path_direction_ = sine_cosine(state_.path_heading_rad);
}

void Odometry::go_along_path() noexcept {
  const auto& [sin, cos] = path_direction_;
  state_.path_x_m = path_[0] + cos * state_.x_m - sin * state_.y_m;
  state_.path_y_m = path_[1] + sin * state_.x_m + cos * state_.y_m;
  const double rad = path_[2] + state_.heading_rad;
  const double turn_rad = rad > std::numbers::pi    ? 2 * std::numbers::pi
                          : rad < -std::numbers::pi ? -2 * std::numbers::pi
                                                    : 0;
  state_.path_heading_rad = rad - turn_rad;
}

// The world drifts on by this tick's share, and so does the direction of 0 in it.
void Odometry::learn_drift(const Way& way, bool all, const Vec3& rate_rad_s, double dt_s) noexcept {
  const double by_rad = drift_rad_s_ * dt_s, x = zero_x_, y = zero_y_;
  const double length = 1.5 - 0.5 * (x * x + y * y);  // keeps it a unit vector
  zero_rad_ += by_rad;
  zero_x_ = length * (x - by_rad * y);
  zero_y_ = length * (y + by_rad * x);
  const auto& [a, b, c] = rate_rad_s;
  const bool quiet = all && way.force_N > 0 && a * a + b * b + c * c < quiet_rad_s * quiet_rad_s;
  quiet_s_ = quiet ? quiet_s_ + dt_s : 0;
  if (quiet_s_ < quiet_s) return;
  learnt_s_ = std::min(learnt_s_ + dt_s, drift_s);
  drift_rad_s_ += (way.turn_Nrad / way.force_N - by_rad) / learnt_s_;
}

void Odometry::go(const Way& way, double yaw_rad) noexcept {
  if (way.force_N > 0) {
    const double x_m = way.x_Nm / way.force_N, y_m = way.y_Nm / way.force_N;
    state_.x_m += zero_x_ * x_m + zero_y_ * y_m;
    state_.y_m += zero_x_ * y_m - zero_y_ * x_m;
  }
  double turned_rad = yaw_rad - zero_rad_;
  if (turned_rad > std::numbers::pi || turned_rad < -std::numbers::pi) {
    const double turn_rad = turned_rad > 0 ? 2 * std::numbers::pi : -2 * std::numbers::pi;
    zero_rad_ += turn_rad;  // for as long as the yaw stays there
    turned_rad -= turn_rad;
  }
  state_.heading_rad = turned_rad;
}

}  // namespace kadans

#include "kick_swing.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

// Along one axis, from one place to another in time_s, with these velocities there.
double way(double from_m, double to_m, double from_m_s, double to_m_s, double share, double time_s) noexcept {
  const double d = to_m - from_m;
  const double s = std::clamp(share, 0.0, 1.0);
  // Linear in the end conditions: the way of a rest-to-rest quintic, and what the velocities add.
  const double first = s + s * s * s * (-6 + s * (8 - 3 * s)), last = s * s * s * (-4 + s * (7 - 3 * s));
  return from_m + d * swing_way(s) + time_s * (from_m_s * first + to_m_s * last);
}

}  // namespace

GroundPoint KickSwing::strike_of(const Config& c, const Kick& asked) noexcept {
  const double behind_m = c.ball_radius_m + c.tip_m;
  return {asked.ball.x_m - behind_m * std::cos(asked.rad), asked.ball.y_m - behind_m * std::sin(asked.rad)};
}

bool KickSwing::reaches(const Config& c, const Kick& asked, double side) noexcept {
  if (!(asked.m_s > 0)) return false;
  const GroundPoint at = strike_of(c, asked);
  const double aside_m = side * at.y_m;
  return std::abs(asked.rad) <= c.rad_max && at.x_m >= c.near_m && at.x_m <= c.far_m && aside_m >= c.inside_m &&
         aside_m <= c.outside_m;
}

void KickSwing::begin(const Config& config, const Kick& asked) noexcept {
  kick = asked;
  strike = strike_of(config, asked);
}

Vec3 KickSwing::at(const Config& c, const Vec3& from_m, const GroundPoint& foothold, double time_s,
                   double whole_s) const noexcept {
  const double x_m_s = kick.m_s * std::cos(kick.rad), y_m_s = kick.m_s * std::sin(kick.rad);
  const double until_s = strike_s(c, kick);
  if (time_s < until_s) {
    const double share = time_s / until_s;
    return {way(from_m[0], strike.x_m, 0, x_m_s, share, until_s), way(from_m[1], strike.y_m, 0, y_m_s, share, until_s),
            from_m[2] * (1 - swing_way(share)) + c.height_m * swing_way(share / 0.7)};
  }
  const double after_s = std::max(whole_s - until_s, 0.01), share = (time_s - until_s) / after_s;
  return {way(strike.x_m, foothold.x_m, x_m_s, 0, share, after_s),
          way(strike.y_m, foothold.y_m, y_m_s, 0, share, after_s), c.height_m * (1 - swing_way(share))};
}

double KickSwing::yaw_rad(const Config& c, double time_s) const noexcept {
  constexpr double still_share = 0.8, still_s = 0.05, back_s = 0.2;  // a foot that turns would spin the ball
  const double until_s = strike_s(c, kick);
  if (time_s < until_s + still_s) return kick.rad * swing_way(time_s / (still_share * until_s));
  return kick.rad * (1 - swing_way((time_s - until_s - still_s) / back_s));
}

}  // namespace kadans

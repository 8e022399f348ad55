#include "fall_watch.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double well_within = 0.8;  // of the angles, to count as standing again

double norm(const Vec3& v) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

}  // namespace

bool FallWatch::beyond(const BaseStatus& base, double rate_rad_s) const noexcept {
  const bool fast = !(rate_rad_s <= settings_.rate_max_rad_s);
  if (phase_ == Phase::fallen) return fast;
  return fast ||
         !(std::abs(base.roll_rad) <= settings_.roll_max_rad && std::abs(base.pitch_rad) <= settings_.pitch_max_rad);
}

void FallWatch::advance(const BaseStatus& base, double rate_rad_s, double dt_s) noexcept {
  const auto lasts = [&](bool condition, double time_s) {
    for_s_ = condition ? for_s_ + dt_s : 0;
    return condition && for_s_ > time_s - 0.5 * dt_s;
  };
  Phase next = phase_;
  if (phase_ == Phase::upright) {
    if (lasts(beyond(base, rate_rad_s), settings_.time_s)) next = Phase::falling;
  } else if (phase_ == Phase::falling) {
    if (lasts(rate_rad_s < settings_.rest_rate_rad_s, settings_.rest_s)) next = Phase::fallen;
  } else if (beyond(base, rate_rad_s)) {
    next = Phase::falling;
  } else {
    const bool stands = std::abs(base.roll_rad) < well_within * settings_.roll_max_rad &&
                        std::abs(base.pitch_rad) < well_within * settings_.pitch_max_rad;
    if (lasts(stands, settings_.rest_s)) next = Phase::upright;
  }
  if (next == phase_) return;
  if (next == Phase::falling) impact_m_s2_ = 0;
  phase_ = next;
  phase_number_ = static_cast<std::uint32_t>(next);
  for_s_ = 0;
}

FaultMask FallWatch::look(const BaseStatus& base, const ImuSample& sample, double dt_s) noexcept {
  using enum FaultCode;
  advance(base, norm(base.angular_velocity_rad_s), dt_s);
  if (phase_ == Phase::falling) {
    share_ = settings_.soft_share;
  } else if (share_ < 1) {
    share_ = std::min(1.0, share_ + dt_s / recover_s_);
  }
  if (phase_ == Phase::upright) return bit_if(!(base.tilt_rad <= tilt_max_rad_), tilt);
  if (phase_ == Phase::fallen) return 0;
  const double acceleration_m_s2 = norm(sample.acceleration_m_s2);
  if (std::isfinite(acceleration_m_s2)) impact_m_s2_ = std::max(impact_m_s2_, acceleration_m_s2);
  return bit(fall) | bit_if(acceleration_m_s2 > settings_.impact_max_m_s2, impact);
}

void FallWatch::describe(const BaseStatus& base, Fault& fault) const noexcept {
  const double rate_rad_s = norm(base.angular_velocity_rad_s);
  if (fault.code == FaultCode::tilt) {
    fault.value = base.tilt_rad;
    fault.limit = tilt_max_rad_;
  } else if (fault.code == FaultCode::impact) {
    fault.value = impact_m_s2_;
    fault.limit = settings_.impact_max_m_s2;
  } else if (fault.code != FaultCode::fall) {
    return;
  } else if (rate_rad_s > settings_.rate_max_rad_s) {
    fault.value = rate_rad_s;
    fault.limit = settings_.rate_max_rad_s;
  } else if (std::abs(base.roll_rad) > settings_.roll_max_rad) {
    fault.value = base.roll_rad;
    fault.limit = settings_.roll_max_rad;
  } else {
    fault.value = base.pitch_rad;
    fault.limit = settings_.pitch_max_rad;
  }
}

}  // namespace kadans

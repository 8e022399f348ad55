
#include "body_watch.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

double largest(const Vec3& v) noexcept { return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])}); }

double largest_step(const Vec3& a, const Vec3& b) noexcept { return largest({a[0] - b[0], a[1] - b[1], a[2] - b[2]}); }

constexpr double negative_share = 0.01;  // of the range: a pressure sensor's zero may drift so far below

}  // namespace

FaultMask ImuWatch::look(const ImuSample& sample, const SensorState& health) noexcept {
  using enum FaultCode;
  if (!settings_.imu) return 0;
  FaultMask found = bit_if(!health.finite, imu_not_finite) |
                    bit_if(health.silent_ticks > silent_ticks_max_ * health.period_ticks, imu_silent);
  if (health.silent_ticks > 0 || !health.finite) return found;
  const Vec3& gyro = sample.angular_velocity_rad_s;
  const Vec3& acceleration = sample.acceleration_m_s2;
  const bool repeated = seen_ && gyro == gyro_rad_s_ && acceleration == acceleration_m_s2_;
  found |= bit_if(repeats_.same(repeated, settings_.imu_stuck_ticks), imu_stuck);
  const double step_rad_s = seen_ ? largest_step(gyro, gyro_rad_s_) : 0;
  const auto check = [&](double value, double most) {
    if (value <= most) return;
    jump_ = value;
    jump_max_ = most;
    found |= bit(imu_jump);
  };
  check(step_rad_s, settings_.gyro_step_rad_s);
  check(largest(gyro), settings_.gyro_max_rad_s);
  check(largest(acceleration), settings_.acceleration_max_m_s2);
  gyro_rad_s_ = gyro;
  acceleration_m_s2_ = acceleration;
  seen_ = true;
  return found;
}

void ImuWatch::describe(const SensorState& health, Fault& fault) const noexcept {
  switch (fault.code) {
    case FaultCode::imu_silent:
      return tell(fault, health.silent_ticks, silent_ticks_max_ * health.period_ticks);
    case FaultCode::imu_stuck:
      return tell(fault, repeats_.count(), settings_.imu_stuck_ticks);
    case FaultCode::imu_jump:
      return tell(fault, jump_, jump_max_);
    default:
      break;
  }
}

FaultMask ChannelWatch::look(const ChannelSample& sample, const SensorState& health) noexcept {
  using enum FaultCode;
  const bool silent = health.silent_ticks > silent_ticks_max_ + health.period_ticks - 1;
  const bool beyond = health.silent_ticks == 0 && health.finite && !(sample.value >= min_ && sample.value <= max_);
  return bit_if(silent, channel_silent) | bit_if(!health.finite, channel_not_finite) | bit_if(beyond, channel_range);
}

void ChannelWatch::describe(const ChannelSample& sample, Fault& fault) const noexcept {
  tell(fault, sample.value, sample.value < min_ ? min_ : max_);
  fault.words = name_;
}

FaultMask FootWatch::look(const FootSample& sample, const SensorState& health) noexcept {
  using enum FaultCode;
  FaultMask found =
      bit_if(!health.finite, foot_not_finite) | bit_if(health.silent_ticks > silent_ticks_max_, foot_silent);
  if (health.silent_ticks > 0 || !health.finite) return found;
  const auto [low, high] = std::minmax_element(sample.force_N.begin(), sample.force_N.end());
  // In the air all forces are none, again and again.
  const bool repeated = sample.force_N == force_N_ && *low > 0;
  found |= bit_if(repeats_.same(repeated, stuck_ticks_), foot_stuck);
  if (*high > force_max_N_ || *low < -negative_share * force_max_N_) {
    worst_N_ = *high > force_max_N_ ? *high : *low;
    found |= bit(foot_jump);
  }
  force_N_ = sample.force_N;
  return found;
}

void FootWatch::describe(const SensorState& health, Fault& fault) const noexcept {
  switch (fault.code) {
    case FaultCode::foot_silent:
      return tell(fault, health.silent_ticks, silent_ticks_max_);
    case FaultCode::foot_stuck:
      return tell(fault, repeats_.count(), stuck_ticks_);
    case FaultCode::foot_jump:
      return tell(fault, worst_N_, force_max_N_);
    default:
      break;
  }
}

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
    tell(fault, base.tilt_rad, tilt_max_rad_);
  } else if (fault.code == FaultCode::impact) {
    tell(fault, impact_m_s2_, settings_.impact_max_m_s2);
  } else if (fault.code != FaultCode::fall) {
    return;
  } else if (rate_rad_s > settings_.rate_max_rad_s) {
    tell(fault, rate_rad_s, settings_.rate_max_rad_s);
  } else if (std::abs(base.roll_rad) > settings_.roll_max_rad) {
    tell(fault, base.roll_rad, settings_.roll_max_rad);
  } else {
    tell(fault, base.pitch_rad, settings_.pitch_max_rad);
  }
}

}  // namespace kadans

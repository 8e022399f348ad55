#include "joint_limiter.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double rate_default_per_s = 1000;  // of the torque limit
// A joint that rests at a stop pushes into it by rounding: of the torque limit, what a stop may take without a fault.
constexpr double resting_share = 1e-3;

}  // namespace

JointLimiter::JointLimiter(const SafetySettings& settings, const JointLimits& limits) noexcept
    : effort_max_Nm_(limits.effort_max_Nm),
      rate_Nm_s_(limits.effort_rate_max_Nm_s > 0 ? limits.effort_rate_max_Nm_s : rate_default_per_s * effort_max_Nm_),
      power_max_W_(limits.power_max_W > 0 ? limits.power_max_W : effort_max_Nm_ * limits.velocity_max_rad_s),
      velocity_max_rad_s_(limits.velocity_max_rad_s),
      velocity_fade_rad_s_(std::max(1e-6, (settings.velocity_margin - 1) * limits.velocity_max_rad_s)),
      lower_rad_(limits.lower_rad),
      upper_rad_(limits.upper_rad),
      zone_rad_(std::min(settings.soft_stop.zone_rad, 0.25 * (limits.upper_rad - limits.lower_rad))),
      stiffness_Nm_per_rad_(settings.soft_stop.stiffness_Nm_per_rad),
      lowest_free_rad_(lower_rad_ + zone_rad_),
      highest_free_rad_(upper_rad_ - zone_rad_),
      damping_Nms_per_rad_(settings.damping_Nms_per_rad) {}

JointLimiter::Interval JointLimiter::soft_stops(double position_rad, Interval effort) const noexcept {
  const double above_rad = position_rad - highest_free_rad_;
  if (above_rad > 0) {
    const double beyond_rad = position_rad - upper_rad_;
    effort.high = beyond_rad > 0 ? std::max(effort.low, -stiffness_Nm_per_rad_ * beyond_rad)
                                 : effort.high * (1 - above_rad / zone_rad_);
  }
  const double below_rad = lowest_free_rad_ - position_rad;
  if (below_rad > 0) {
    const double beyond_rad = lower_rad_ - position_rad;
    effort.low = beyond_rad > 0 ? std::min(effort.high, stiffness_Nm_per_rad_ * beyond_rad)
                                : effort.low * (1 - below_rad / zone_rad_);
  }
  return effort;
}

JointLimiter::Interval JointLimiter::soft_speed(double velocity_rad_s, Interval effort) const noexcept {
  const double too_fast_rad_s = std::abs(velocity_rad_s) - velocity_max_rad_s_;
  if (!(too_fast_rad_s > 0)) return effort;
  const double share = std::max(0.0, 1 - too_fast_rad_s / velocity_fade_rad_s_);
  if (velocity_rad_s > 0) effort.high = std::min(effort.high, std::max(effort.low, share * effort_max_Nm_));
  if (velocity_rad_s < 0) effort.low = std::max(effort.low, std::min(effort.high, -share * effort_max_Nm_));
  return effort;
}

double JointLimiter::power_bound_Nm(double velocity_rad_s, double effort_Nm) const noexcept {
  const double speed_rad_s = std::abs(velocity_rad_s);
  return speed_rad_s * effort_Nm > power_max_W_ ? power_max_W_ / speed_rad_s : effort_Nm;
}

FaultMask JointLimiter::cut(const Input& in, JointActuation& actuation) noexcept {
  of_set_point_ = 0;
  FaultMask found = actuation.mode == ActuationMode::effort ? 0 : limit_set_point(in.state.position_rad, actuation);
  const double asked_Nm = actuation.effort_Nm;
  const double most_Nm = power_bound_Nm(in.state.velocity_rad_s, effort_max_Nm_ * in.derating * in.recovery);
  Interval bound = soft_speed(in.state.velocity_rad_s, {-most_Nm, most_Nm});
  bound = soft_stops(in.state.position_rad, bound);
  const double step_Nm = rate_Nm_s_ * in.change_s;
  const double rated_Nm = std::clamp(asked_Nm, in.last_Nm - step_Nm, in.last_Nm + step_Nm);
  const double given_Nm = std::clamp(rated_Nm, bound.low, bound.high);
  actuation.effort_Nm = given_Nm;
  if (given_Nm != asked_Nm) {
    asked_Nm_ = asked_Nm;
    found |= who_cut(in, asked_Nm);
  }
  return found;
}

// Between these the speed asked may be: into a soft stop it fades to none at the limit.
JointLimiter::Interval JointLimiter::speeds(double position_rad) const noexcept {
  const auto share = [&](double left_rad) { return left_rad < zone_rad_ ? std::max(0.0, left_rad / zone_rad_) : 1; };
  return {-velocity_max_rad_s_ * share(position_rad - lower_rad_),
          velocity_max_rad_s_ * share(upper_rad_ - position_rad)};
}

FaultMask JointLimiter::limit_set_point(double position_rad, JointActuation& actuation) noexcept {
  if (actuation.mode == ActuationMode::off) return 0;
  const Interval bound = speeds(position_rad);
  asked_rad_s_ = actuation.velocity_rad_s;
  actuation.velocity_rad_s = given_rad_s_ = std::clamp(asked_rad_s_, bound.low, bound.high);
  if (std::abs(asked_rad_s_) > velocity_max_rad_s_) of_set_point_ |= bit(FaultCode::soft_speed);
  // A spring or damper that pushes is none.
  actuation.stiffness_Nm_per_rad = std::max(0.0, actuation.stiffness_Nm_per_rad);
  actuation.damping_Nms_per_rad = std::max(0.0, actuation.damping_Nms_per_rad);
  asked_rad_ = given_rad_ = position_rad;
  if (has_position(actuation.mode)) {
    asked_rad_ = actuation.position_rad;
    actuation.position_rad = given_rad_ = std::clamp(asked_rad_, lower_rad_, upper_rad_);
    if (given_rad_ != asked_rad_) of_set_point_ |= bit(FaultCode::soft_stop);
  }
  const bool by_stop = given_rad_s_ != std::clamp(asked_rad_s_, -velocity_max_rad_s_, velocity_max_rad_s_);
  if (by_stop) of_set_point_ |= bit(FaultCode::soft_stop);
  return of_set_point_;
}

// Each limit for itself, whether it would have cut.
FaultMask JointLimiter::who_cut(const Input& in, double asked_Nm) const noexcept {
  const double most_Nm = effort_max_Nm_ * in.derating;
  const double step_Nm = rate_Nm_s_ * in.change_s;
  const Interval whole{-most_Nm, most_Nm};
  const auto cuts = [&](const Interval& bound) { return asked_Nm < bound.low || asked_Nm > bound.high; };
  const double powered_Nm = power_bound_Nm(in.state.velocity_rad_s, most_Nm);
  FaultMask cut = bit_if(cuts(whole), FaultCode::effort_limit) |
                  bit_if(powered_Nm < most_Nm && cuts({-powered_Nm, powered_Nm}), FaultCode::power_limit) |
                  bit_if(cuts({in.last_Nm - step_Nm, in.last_Nm + step_Nm}), FaultCode::effort_rate_limit);
  const Interval stops = soft_stops(in.state.position_rad, whole);
  const double rest_Nm = resting_share * effort_max_Nm_;
  if ((stops.low > whole.low || stops.high < whole.high) && cuts({stops.low - rest_Nm, stops.high + rest_Nm}))
    cut |= bit(FaultCode::soft_stop);
  const Interval speed = soft_speed(in.state.velocity_rad_s, whole);
  if ((speed.low > whole.low || speed.high < whole.high) && cuts(speed)) cut |= bit(FaultCode::soft_speed);
  return cut;
}

JointActuation JointLimiter::damp(const JointState& state) const noexcept {
  const double effort_Nm = -damping_Nms_per_rad_ * state.velocity_rad_s;
  if (!std::isfinite(effort_Nm)) return {};
  const double most_Nm = power_bound_Nm(state.velocity_rad_s, effort_max_Nm_);
  return {.effort_Nm = std::clamp(effort_Nm, -most_Nm, most_Nm), .mode = ActuationMode::effort};
}

void JointLimiter::describe(const Input& in, Fault& fault) const noexcept {
  switch (fault.code) {
    case FaultCode::effort_limit:
      return tell(fault, asked_Nm_, effort_max_Nm_ * in.derating);
    case FaultCode::effort_rate_limit:
      return tell(fault, in.change_s > 0 ? (asked_Nm_ - in.last_Nm) / in.change_s : 0, rate_Nm_s_);
    case FaultCode::power_limit:
      return tell(fault, asked_Nm_ * in.state.velocity_rad_s, power_max_W_);
    case FaultCode::soft_stop:
      if ((of_set_point_ & bit(fault.code)) != 0 && given_rad_ != asked_rad_)
        return tell(fault, asked_rad_, given_rad_);
      return tell(fault, in.state.position_rad,
                  2 * in.state.position_rad > lower_rad_ + upper_rad_ ? highest_free_rad_ : lowest_free_rad_);
    case FaultCode::soft_speed:
      return tell(fault, (of_set_point_ & bit(fault.code)) != 0 ? asked_rad_s_ : in.state.velocity_rad_s,
                  velocity_max_rad_s_);
    default:
      fault.value = asked_Nm_;
  }
}

}  // namespace kadans

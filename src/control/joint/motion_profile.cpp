#include "kadans/control/motion_profile.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

using Limits = MotionProfile::Limits;
using Phase = MotionProfile::Phase;

constexpr int search_steps_max = 60;
// Of the way that is left; the rest is cruised, so the target is met exactly and the duration to about this share.
constexpr double fastest_tolerance = 1e-8, slower_tolerance = 1e-6;

SetpointState advance(const SetpointState& s, double jerk, double t) noexcept {
  if (t == 0) return s;  // many phases are empty
  return {s.value + t * (s.velocity + t * (0.5 * s.acceleration + t * jerk / 6)),
          s.velocity + t * (s.acceleration + 0.5 * t * jerk), s.acceleration + t * jerk};
}

// From one velocity and acceleration to another velocity without acceleration, in the least time.
struct Change {
  std::array<Phase, 3> phases;
  double way = 0, duration_s = 0;
};

Change change_velocity(double velocity, double acceleration, double to, const Limits& limits) noexcept {
  const double j = limits.jerk;
  // Where the velocity goes when the acceleration is taken back at once tells in which direction to accelerate.
  const double sign = to - velocity >= 0.5 * acceleration * std::abs(acceleration) / j ? 1 : -1;
  const double a = sign * acceleration, gain = sign * (to - velocity);
  const double free_peak = std::sqrt(std::max(0.0, j * gain + 0.5 * a * a));
  const double peak = std::min(free_peak, limits.acceleration);
  const double rise = peak - a, direction = rise < 0 ? -1 : 1;
  const double gained = 0.5 * (direction * (peak * peak - a * a) + peak * peak) / j;
  const double hold_s = peak < free_peak ? std::max(0.0, (gain - gained) / peak) : 0;

  Change change;
  change.phases = {{{sign * direction * j, std::abs(rise) / j}, {0, hold_s}, {-sign * j, peak / j}}};
  SetpointState s{0, velocity, acceleration};
  for (const Phase& phase : change.phases) {
    s = advance(s, phase.jerk, phase.duration_s);
    change.duration_s += phase.duration_s;
  }
  change.way = s.value;
  return change;
}

// A state seen so that the way still to go points forward: to `peak` >= 0, then to rest.
struct Plan {
  Change to_peak, to_rest;
  double peak = 0;
  double way() const noexcept { return to_peak.way + to_rest.way; }
  double duration_s() const noexcept { return to_peak.duration_s + to_rest.duration_s; }
  double cruise_s(double whole_way) const noexcept { return peak > 0 ? std::max(0.0, (whole_way - way()) / peak) : 0; }
};

Plan plan_with_peak(const SetpointState& from, double peak, const Limits& limits) noexcept {
  return {change_velocity(from.velocity, from.acceleration, peak, limits), change_velocity(peak, 0, 0, limits), peak};
}

// A zero of `f` in [low, high], with f(low) < 0 < f(high), approached from below: regula falsi with halved ends
// (Illinois; Dowell and Jarratt 1971, BIT 11), every fourth step a bisection, so that the bracket surely shrinks.
template <typename Function>
double zero_from_below(Function f, double low, double f_low, double high, double f_high, double tolerance) noexcept {
  double weight_low = 1, weight_high = 1;
  for (int i = 1; i <= search_steps_max && f_low < -tolerance; ++i) {
    const double g_low = weight_low * f_low, g_high = weight_high * f_high;
    const double x = i % 4 == 0 ? 0.5 * (low + high) : (low * g_high - high * g_low) / (g_high - g_low);
    const double y = f(x);
    if (y > 0) {
      weight_low *= 0.5;
      weight_high = 1;
      high = x;
      f_high = y;
    } else {
      weight_high *= 0.5;
      weight_low = 1;
      low = x;
      f_low = y;
    }
  }
  return low;
}

Plan fastest_plan(const SetpointState& from, double way, double way_to_stop, const Limits& limits) noexcept {
  const Plan fast = plan_with_peak(from, limits.velocity, limits);
  if (fast.way() <= way) return fast;
  const auto too_far = [&](double peak) { return plan_with_peak(from, peak, limits).way() - way; };
  const double peak = zero_from_below(too_far, 0, way_to_stop - way, limits.velocity, fast.way() - way,
                                      fastest_tolerance * std::abs(way - way_to_stop));
  return plan_with_peak(from, peak, limits);
}

// A lower peak, and a cruise, that make the motion last longer than the fastest one. The function is the way that is
// missing when what is left of the duration is cruised: 0 where both fit.
Plan slower_plan(const SetpointState& from, double way, double way_to_stop, double duration_s, const Plan& fastest,
                 const Limits& limits) noexcept {
  const auto surplus = [&](double peak) {
    const Plan plan = plan_with_peak(from, peak, limits);
    return peak * (duration_s - plan.duration_s()) - (way - plan.way());
  };
  const double peak = zero_from_below(surplus, 0, way_to_stop - way, fastest.peak, surplus(fastest.peak),
                                      slower_tolerance * std::abs(way - way_to_stop));
  return plan_with_peak(from, peak, limits);
}

}  // namespace

void MotionProfile::reset(double position) noexcept {
  state_ = {position, 0, 0};
  target_ = position;
  phase_ = phase_count;
  remaining_s_ = 0;
}

void MotionProfile::set_state(const SetpointState& state) noexcept {
  reset(state.value);
  state_ = state;
}

void MotionProfile::begin_plan(double target) noexcept {
  phase_ = 0;
  time_s_ = 0;
  phase_start_ = state_;
  target_ = target;
  remaining_s_ = 0;
  for (const Phase& phase : phases_) remaining_s_ += phase.duration_s;
}

void MotionProfile::stop(const Limits& limits) noexcept {
  const Change change = change_velocity(state_.velocity, state_.acceleration, 0, limits);
  phases_ = {};
  std::copy(change.phases.begin(), change.phases.end(), phases_.begin());
  begin_plan(state_.value + change.way);
}

bool MotionProfile::move(double target, const Limits& limits, double duration_s) noexcept {
  const double way_to_stop = change_velocity(state_.velocity, state_.acceleration, 0, limits).way;
  const double rest = target - state_.value - way_to_stop;
  const double sign = rest < 0 ? -1 : 1;
  const SetpointState from{0, sign * state_.velocity, sign * state_.acceleration};
  const double way = sign * (target - state_.value), stop_way = sign * way_to_stop;

  Plan plan = rest == 0 ? plan_with_peak(from, 0, limits) : fastest_plan(from, way, stop_way, limits);
  const double fastest_s = plan.duration_s() + plan.cruise_s(way);
  const bool in_time = !(duration_s > 0) || duration_s >= fastest_s;
  if (rest != 0 && duration_s > fastest_s) plan = slower_plan(from, way, stop_way, duration_s, plan, limits);

  for (std::size_t i = 0; i < 3; ++i) {
    phases_[i] = {sign * plan.to_peak.phases[i].jerk, plan.to_peak.phases[i].duration_s};
    phases_[i + 4] = {sign * plan.to_rest.phases[i].jerk, plan.to_rest.phases[i].duration_s};
  }
  phases_[3] = {0, plan.cruise_s(way)};
  begin_plan(target);
  return in_time;
}

const SetpointState& MotionProfile::step(double dt_s) noexcept {
  if (phase_ == phase_count) return state_;
  time_s_ += dt_s;
  remaining_s_ = std::max(0.0, remaining_s_ - dt_s);
  while (phase_ < phase_count && time_s_ >= phases_[phase_].duration_s) {
    const Phase& phase = phases_[phase_++];
    phase_start_ = advance(phase_start_, phase.jerk, phase.duration_s);
    time_s_ -= phase.duration_s;
  }
  if (phase_ == phase_count) {
    reset(target_);
  } else {
    state_ = advance(phase_start_, phases_[phase_].jerk, time_s_);
  }
  return state_;
}

}  // namespace kadans

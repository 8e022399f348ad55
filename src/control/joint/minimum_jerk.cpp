#include "kadans/control/minimum_jerk.h"

namespace kadans {

void MinimumJerk::reset(double position) noexcept {
  state_ = {position, 0, 0};
  target_ = position;
  remaining_s_ = 0;
}

void MinimumJerk::start(double position, double velocity, double target, double duration_s) noexcept {
  state_ = {position, velocity, 0};
  move(target, duration_s);
}

void MinimumJerk::move(double target, double duration_s) noexcept {
  if (!(duration_s > 0)) return reset(target);
  target_ = target;
  remaining_s_ = duration_s;
}

void MinimumJerk::follow(const SetpointState& state) noexcept {
  state_ = state;
  target_ = state.value;
  remaining_s_ = 0;
}

void MinimumJerk::stop(double duration_s) noexcept {
  if (remaining_s_ > 0 || state_.velocity != 0) move(state_.value + 0.5 * duration_s * state_.velocity, duration_s);
}

// The quintic that leads from the present state to rest at the target in the time that is left, taken dt further. The
// polynomial is found anew each step from the state; exact arithmetic would find the same one each time.
void MinimumJerk::advance(double dt_s) noexcept {
  if (remaining_s_ <= 1.5 * dt_s) return reset(target_);
  const double T = remaining_s_;
  const double way = target_ - state_.value;
  const double v = state_.velocity * T;  // scaled to time 0..1
  const double half_a = 0.5 * state_.acceleration * T * T;
  const double c3 = 10 * way - 6 * v - 3 * half_a;
  const double c4 = -15 * way + 8 * v + 3 * half_a;
  const double c5 = 6 * way - 3 * v - half_a;
  const double t = dt_s / T;
  state_.value += t * (v + t * (half_a + t * (c3 + t * (c4 + t * c5))));
  state_.velocity = (v + t * (2 * half_a + t * (3 * c3 + t * (4 * c4 + t * 5 * c5)))) / T;
  state_.acceleration = (2 * half_a + t * (6 * c3 + t * (12 * c4 + t * 20 * c5))) / (T * T);
  remaining_s_ -= dt_s;
}

}  // namespace kadans

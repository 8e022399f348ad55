// A motion of a set-point from its present position, velocity and acceleration to rest at a target in a given time: the
// quintic polynomial, which from rest to rest is the minimum-jerk motion (Flash and Hogan 1985, J. Neurosci. 5(7), eq.
// 4). A new target during a motion makes no step in position, velocity or acceleration.
#pragma once

#include "kadans/signal/setpoint.h"

namespace kadans {

class MinimumJerk {
 public:
  // At rest at `position`, at once.
  void reset(double position) noexcept;
  // At `position`, moving with `velocity`, to rest at `target` after duration_s > 0.
  void start(double position, double velocity, double target, double duration_s) noexcept;
  // Reaches `target` at rest after duration_s > 0; at once for 0.
  void move(double target, double duration_s) noexcept;
  // Takes a state of a motion that another part plans, and stays there until the next call.
  void follow(const SetpointState& state) noexcept;
  // Comes to rest in duration_s, after half the way that it would go at its present velocity.
  void stop(double duration_s) noexcept;

  const SetpointState& step(double dt_s) noexcept {
    if (!(remaining_s_ <= 0)) advance(dt_s);
    return state_;
  }
  const SetpointState& state() const noexcept { return state_; }
  double target() const noexcept { return target_; }
  double remaining_s() const noexcept { return remaining_s_; }  // 0 at rest
  void pass_state(auto& bytes) noexcept { bytes(state_, target_, remaining_s_); }

 private:
  void advance(double dt_s) noexcept;

  SetpointState state_;
  double target_ = 0;
  double remaining_s_ = 0;
};

}  // namespace kadans

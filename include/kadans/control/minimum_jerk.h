// A motion from where a set-point is now, with the velocity and acceleration it has, to rest at a target in a given
// time: the quintic polynomial, which from rest to rest is the minimum-jerk motion (Flash and Hogan 1985, J. Neurosci.
// 5(7), eq. 4). Taking over a motion under way never steps position, velocity or acceleration.
#pragma once

namespace kadans {

class MinimumJerk {
 public:
  struct State {
    double position = 0, velocity = 0, acceleration = 0;
  };

  // At rest at `position`, at once.
  void reset(double position) noexcept;
  // At `position`, moving with `velocity`, to rest at `target` after duration_s > 0.
  void start(double position, double velocity, double target, double duration_s) noexcept;
  // Reaches `target` at rest after duration_s > 0; at once for 0.
  void move(double target, double duration_s) noexcept;
  // Is led along the motion of somebody else: here, and moving so. Stays at this state until told more.
  void follow(const State& state) noexcept;
  // Comes to rest in duration_s, half the way that its velocity would have brought it.
  void stop(double duration_s) noexcept;

  const State& step(double dt_s) noexcept;
  const State& state() const noexcept { return state_; }
  double target() const noexcept { return target_; }
  double remaining_s() const noexcept { return remaining_s_; }  // 0 at rest

 private:
  State state_;
  double target_ = 0;
  double remaining_s_ = 0;
};

}  // namespace kadans

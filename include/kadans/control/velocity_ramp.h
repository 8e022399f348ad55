// A velocity that goes to its set-point with limited acceleration and brakes before the end of the way.
//
// Let d be the way that is left, a the acceleration and dt the tick. The fastest velocity v from which the motion still
// stops in time satisfies v dt + v^2 / 2a = d. A velocity that follows this bound never needs more than a and comes to
// rest at the end, not beyond it. Braking before the end uses the full acceleration, whatever the duration of a
// set-point.
#pragma once

namespace kadans {

class VelocityRamp {
 public:
  // Starts with `velocity`; the set-point is 0, reached after duration_s.
  void start(double velocity, double duration_s) noexcept;
  // Reaches `goal` after duration_s, or as soon as the acceleration allows.
  void move(double goal, double duration_s) noexcept;
  // `below` and `above`: the way that is left in the negative and the positive direction, < 0 beyond the end.
  // acceleration_max > 0.
  double step(double dt_s, double acceleration_max, double below, double above) noexcept;

  double velocity() const noexcept { return velocity_; }
  double goal() const noexcept { return goal_; }
  bool limited() const noexcept { return limited_; }  // brakes for the end of the way
  // Time until the set-point is reached; 0 while limited.
  double remaining_s() const noexcept { return remaining_s_; }
  void pass_state(auto& bytes) noexcept { bytes(velocity_, goal_, asked_acceleration_, remaining_s_, limited_); }

 private:
  double velocity_ = 0;
  double goal_ = 0;
  double asked_acceleration_ = 0;  // 0: as fast as allowed
  double remaining_s_ = 0;
  bool limited_ = false;
};

}  // namespace kadans

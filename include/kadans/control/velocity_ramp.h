// A velocity that goes to its set-point with limited acceleration and brakes before the end of the way.
//
// With the way d left and the acceleration a the fastest velocity v from which the motion still stops in time, in steps
// of dt, satisfies v dt + v^2 / 2a = d. Following that bound never asks for more than a, and it brings the motion to
// rest at the end, not beyond it. For the end of the way the full acceleration is used, whatever a set-point's duration
// asks.
#pragma once

namespace kadans {

class VelocityRamp {
 public:
  // Moving with `velocity`; the set-point is 0, reached after duration_s.
  void start(double velocity, double duration_s) noexcept;
  // Reaches `goal` after duration_s, or as soon as the acceleration allows.
  void move(double goal, double duration_s) noexcept;
  // `below` and `above` are the ways left in either direction; less than 0 beyond the end. acceleration_max > 0.
  double step(double dt_s, double acceleration_max, double below, double above) noexcept;

  double velocity() const noexcept { return velocity_; }
  double goal() const noexcept { return goal_; }
  bool limited() const noexcept { return limited_; }  // the end of the way is in the way
  // Until the set-point is reached; 0 while limited.
  double remaining_s() const noexcept { return remaining_s_; }

 private:
  double velocity_ = 0;
  double goal_ = 0;
  double asked_acceleration_ = 0;  // 0: as fast as allowed
  double remaining_s_ = 0;
  bool limited_ = false;
};

}  // namespace kadans

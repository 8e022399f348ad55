// A motion from any state to rest at a target, as fast as limits of velocity, acceleration and jerk allow. The target
// may change at any time. A new target makes a new plan, in bounded time. The plan is followed exactly: each phase is a
// cubic.
//
// A plan changes the velocity to a peak, keeps it for a while and changes it to 0. Both changes take the least time
// that acceleration and jerk allow (Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots,
// Springer 2008, sec. 3.4; with a start in motion Kroeger and Wahl 2010, IEEE Trans. Robotics 26(1)). The direction of
// the peak is that of the way which remains after the present motion is brought to rest. The way grows with the peak.
// So either the peak is the velocity limit and is kept for a while, or a search in a bracket finds the peak that needs
// no cruise. A slower motion of a given duration is the same with a lower peak.
//
// From rest to rest the motion is time-optimal; it never turns back and never passes the target. From a state in motion
// it also keeps the limits and is near the optimum. A state outside the limits is brought inside with the allowed jerk
// and acceleration.
//
// One owner; nothing here allocates, locks or throws. The limits are greater than 0; units are up to the owner.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/signal/setpoint.h"

namespace kadans {

class MotionProfile {
 public:
  struct Limits {
    double velocity = 1, acceleration = 10, jerk = 100;
  };

  // At rest at `position`, at once.
  void reset(double position) noexcept;
  // Takes a state in motion. Call move or stop next.
  void set_state(const SetpointState& state) noexcept;
  // Reaches `target` at rest after duration_s. False when that is too soon: then as soon as the limits allow.
  bool move(double target, const Limits& limits, double duration_s = 0) noexcept;
  // Comes to rest as soon as the limits allow.
  void stop(const Limits& limits) noexcept;

  const SetpointState& step(double dt_s) noexcept;
  const SetpointState& state() const noexcept { return state_; }
  double target() const noexcept { return target_; }
  double remaining_s() const noexcept { return remaining_s_; }  // 0 at rest

  void pass_state(auto& bytes) noexcept {
    bytes(phases_, phase_, time_s_, phase_start_, state_, target_, remaining_s_);
    bytes.must(phase_ <= phase_count);
  }

  // Constant jerk for a time.
  struct Phase {
    double jerk = 0, duration_s = 0;
  };

 private:
  static constexpr std::size_t phase_count = 7;  // change, cruise, change

  void begin_plan(double target) noexcept;

  std::array<Phase, phase_count> phases_{};
  std::size_t phase_ = phase_count;  // under way
  double time_s_ = 0;                // since the phase began
  SetpointState phase_start_;
  SetpointState state_;
  double target_ = 0;
  double remaining_s_ = 0;
};

}  // namespace kadans

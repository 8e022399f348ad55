// Where the base is on the ground, from the feet that stand.
//
// A foot that bears the robot rests on the ground where its pressure has its middle. So while it tips over its toes or
// rolls off its heel, the point of the sole that is under this middle stands still for a moment, and the base moves by
// what that point moves backward from the base. Each tick adds the way of the feet that bore in the last tick and bear
// now, each by its load. No foot is held to have stood since it landed: a foot whose frame is led forward by its toes
// would leave the base behind.
//
// The heading is the gyro's (orientation_filter.h), less its drift about the vertical. The drift shows while the robot
// stands: then its feet do not turn, and the gyro says that they do.
//
// It falls short where feet slip, and it knows nothing of the way of a robot that flies or lies: then it is not valid
// until the next reset, although it goes on counting what feet say. A hop of lifted_s is allowed, and counts as no way.
//
// The path is the same way without the resets: the world model keeps the places of things along it.
//
// One owner, the control thread.
#pragma once

#include <array>

#include "kadans/signal/status.h"
#include "signal/sine_cosine.h"

namespace kadans {

class Odometry {
 public:
  static constexpr double lifted_s = 0.1;
  static constexpr double quiet_rad_s = 0.1;  // a base that turns more slowly stands still, if all feet bear,
  static constexpr double quiet_s = 0.2;      // after so long
  static constexpr double drift_s = 10;       // of standing, over which the drift is averaged

  // Of the base in a tick, along the axes of the orientation filter's world.
  struct Way {
    std::size_t feet = 0;  // that told of it
    double force_N = 0, x_Nm = 0, y_Nm = 0, turn_Nrad = 0;
    // The foot seems to have turned by turn_rad on the ground.
    void add(double load_N, double x_m, double y_m, double turn_rad) noexcept {
      ++feet;
      force_N += load_N;
      x_Nm += load_N * x_m;
      y_Nm += load_N * y_m;
      turn_Nrad += load_N * turn_rad;
    }
  };

  // Where the base is now becomes 0, as of the next update.
  void reset() noexcept { resets_ = true; }

  // heading: where the base points, a unit vector in that world. all: every foot bears.
  void update(const Way& way, bool all, const std::array<double, 2>& heading, const BaseStatus& base, double dt_s,
              OdometryStatus& status) noexcept;
  void pass_state(auto& bytes) noexcept {
    bytes(state_, zero_rad_, zero_x_, zero_y_, path_, path_direction_, lifted_s_, drift_rad_s_, quiet_s_, learnt_s_,
          resets_);
  }

 private:
  void learn_drift(const Way& way, bool all, const Vec3& rate_rad_s, double dt_s) noexcept;
  void go(const Way& way, double yaw_rad) noexcept;
  void begin_path() noexcept;
  void go_along_path() noexcept;

  OdometryStatus state_{.valid = true};
  double zero_rad_ = 0, zero_x_ = 1, zero_y_ = 0;      // where a heading of 0 is in the world that drifts
  std::array<double, 3> path_{};                       // x_m, y_m, heading_rad of the path at the last reset
  SineCosine path_direction_{.sine = 0, .cosine = 1};  // of that heading
  double lifted_s_ = 0;
  double drift_rad_s_ = 0, quiet_s_ = 0, learnt_s_ = 0;
  bool resets_ = false;
};

}  // namespace kadans

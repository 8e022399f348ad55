// Orientation of the base from gyro and accelerometer.
//
// The explicit complementary filter on SO(3) with bias estimation (Mahony, Hamel, Pflimlin: Nonlinear complementary
// filters on the special orthogonal group, IEEE TAC 53(5), 2008, equations 32), on quaternions. The gyro is integrated;
// the accelerometer, which at rest points up, turns the estimate slowly towards gravity and teaches the gyro's bias.
// A robot that steps, falls or hits the floor feels more or less than gravity: the correction fades out linearly
// until | |a| / g - 1 | reaches gravity_tolerance. Yaw is not observable: it starts at 0 and drifts with the rest of
// the bias about the vertical.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include "kadans/signal/frames.h"

namespace kadans {

class OrientationFilter {
 public:
  struct Config {
    double accelerometer_gain_per_s = 0.5;  // >= 0
    double gyro_bias_gain_per_s2 = 0.05;    // >= 0
    double gravity_tolerance = 0.2;         // > 0
    double gyro_bias_max_rad_s = 0.2;       // >= 0; no axis' bias is learnt beyond it
  };
  struct State {
    Quat orientation{1, 0, 0, 0};      // base axes to world axes
    Vec3 angular_velocity_rad_s{};     // in the base frame, without the bias
    Vec3 gyro_bias_rad_s{};            // learnt so far
    double gravity_weight = 0;         // 1: the accelerometer is trusted fully, 0: not at all
    bool gyro_bias_saturated = false;  // an axis' bias is at its maximum
    bool initialised = false;          // has seen gravity once; before, the orientation is the identity
  };

  explicit OrientationFilter(const Config& config);  // throws std::invalid_argument naming field, value and range

  // The gyro's reading, and the specific force, in the base frame; elapsed_s since the last reading, > 0. Roll and
  // pitch start from the first specific force between 0.5 and 1.5 g. A gyro reading or time that is not finite changes
  // nothing; a specific force that is not finite is left out.
  void update(const Vec3& gyro_rad_s, const Vec3& specific_force_m_s2, double elapsed_s) noexcept;

  const State& state() const noexcept { return state_; }
  // Where the base will be so long after the last reading if it goes on turning as it does.
  Quat orientation_after(double time_s) const noexcept;
  void pass_state(auto& bytes) noexcept { bytes(state_, last_gyro_rad_s_); }

 private:
  void initialise(const Vec3& specific_force_m_s2) noexcept;
  void correct(const Vec3& specific_force_m_s2, double norm_m_s2, double elapsed_s) noexcept;
  void learn_bias(const Vec3& error, double elapsed_s) noexcept;

  Config config_;
  State state_;
  Vec3 last_gyro_rad_s_{};
};

}  // namespace kadans

// How fast the base moves over the ground.
//
// The accelerometer says how this velocity changes, whatever legs and feet do: what it feels, along the axes of the
// orientation filter's world and without gravity, is added up. The feet that bear tell the velocity itself, through
// joints and gyro. On springs, and while a foot tips or lands, they are wrong by more than the pushes that balance is to
// catch, but not for long; what is added up is right at once and drifts slowly, by an error of the attitude or of the
// accelerometer. So the feet correct it at a slow rate (a complementary filter). Without a foot that bears for carried_s
// nothing is known, and the velocity is told as 0.
//
// One owner, the control thread. Nothing allocates or throws.
#pragma once

#include <algorithm>
#include <cmath>

#include "leg_chain.h"
#include "orientation_filter.h"

namespace kadans {

class BaseVelocity {
 public:
  static constexpr double carried_s = 0.3;

  // by_feet_per_s: the rate of their correction.
  explicit BaseVelocity(double by_feet_per_s) noexcept : by_feet_per_s_(by_feet_per_s) {}

  // A reading of the accelerometer, with the base's axes in the world as of then; elapsed_s since the last one.
  void felt(const Axes& base, const Vec3& specific_force_m_s2, double elapsed_s) noexcept {
    if (!is_finite(specific_force_m_s2) || !(lifted_s_ < carried_s)) return;
    const Vec3 force_m_s2 = along(base, specific_force_m_s2);
    const double time_s = std::min(elapsed_s, 0.05);
    velocity_m_s_[0] += time_s * force_m_s2[0];
    velocity_m_s_[1] += time_s * force_m_s2[1];
    velocity_m_s_[2] += time_s * (force_m_s2[2] - gravity_m_s2);
  }
  // What the feet that bear say in this tick: way_m of the base along the world's axes. feet: how many do.
  void walked(std::size_t feet, const Vec3& way_m, double dt_s) noexcept {
    lifted_s_ = feet > 0 ? 0 : std::min(lifted_s_ + dt_s, carried_s);
    if (!(lifted_s_ < carried_s)) velocity_m_s_ = {};
    if (feet == 0) return;
    const double share = std::min(by_feet_per_s_ * dt_s, 1.0);
    for (std::size_t i = 0; i < 3; ++i)
      velocity_m_s_[i] += share * (way_m[i] / dt_s - velocity_m_s_[i]);
  }

  const Vec3& velocity_m_s() const noexcept { return velocity_m_s_; }  // along the world's axes
  void pass_state(auto& bytes) noexcept { bytes(velocity_m_s_, lifted_s_); }

 private:
  double by_feet_per_s_;
  Vec3 velocity_m_s_{};
  double lifted_s_ = 0;
};

}  // namespace kadans

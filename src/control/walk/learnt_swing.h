// What a leg's swings teach the next one. All swings of a walk are nearly the same, so what the springs had to give to
// lead one of them is known before the next: friction, the weight of the shank, the torque that starts and stops the
// leg. A share of it is given ahead, at the same time of the swing (iterative learning control; Bristow, Tharayil and
// Alleyne 2006, IEEE Control Systems 26(3)), and the springs lag less from swing to swing.
//
// One owner, the control thread; nothing allocates.
#pragma once

#include <array>
#include <cstddef>

#include "led_leg.h"

namespace kadans {

class LearntSwing {
 public:
  using Efforts = LegInverse::Angles;

  // The torques to give ahead at this time of the swing. 0 beyond the time that swings are learnt for, 0.47 s. A moment
  // that no swing reaches has what the moments before it have.
  Efforts at(double time_s) const noexcept;
  // The torques that the springs gave at this time.
  void see(double time_s, const Efforts& spring_Nm) noexcept;
  // The swing is over: from now on this share of what was seen is given ahead too, at most `most_Nm` in all.
  void learn(double share, const Efforts& most_Nm) noexcept;

  void pass_state(auto& bytes) noexcept { bytes(learnt_Nm_, seen_); }

 private:
  static constexpr std::size_t moments = 32;
  struct Seen {
    Efforts sum_Nm{};
    double times = 0;
  };
  std::array<Efforts, moments> learnt_Nm_{};
  std::array<Seen, moments> seen_{};
};

}  // namespace kadans

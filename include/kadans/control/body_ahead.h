// A robot that stands on two feet, as it is or a moment ahead: the kinematics of the measured state, moved on with the
// filtered joint velocities and the gyro, so that a velocity of any point is a difference in which no position is
// differentiated. What the measures of balance are made of.
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/control/control_object.h"
#include "kadans/model/kinematics.h"

namespace kadans {

inline constexpr double gravity_of_balance_m_s2 = 9.81;
inline constexpr double lowest_com_m = 0.1;  // over the feet's frames; below, a robot does not stand
inline constexpr double moment_s = 0.001;    // how far ahead velocities are looked for

class BodyAhead {
 public:
  // Of the options left_foot and right_foot: the links that stand. Throws OptionError. Keeps a reference to the model.
  explicit BodyAhead(const ObjectSetup& setup);

  // The base's origin at 0, the base turned by `upright` and by what it turns in ahead_s.
  void update(const ControlInput& input, const Quat& upright, double ahead_s) noexcept;

  const Kinematics& kinematics() const noexcept { return kinematics_; }      // as of the last update
  const std::array<std::size_t, 2>& feet() const noexcept { return feet_; }  // links, left and right
  const Pose& foot(std::size_t foot) const noexcept { return kinematics_.link(feet_[foot]); }

 private:
  std::array<std::size_t, 2> feet_{};
  Kinematics kinematics_;
  std::size_t joint_count_;
};

}  // namespace kadans

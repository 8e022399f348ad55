// The kinematics of a robot on two feet, now or a moment ahead. The state a moment ahead is the measured state, moved
// on with the filtered joint velocities and the gyro. So the velocity of any point is the difference between the two,
// and no measured position is differentiated. The measures of balance are built on this.
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <array>
#include <cstddef>

#include "kadans/control/control_object.h"
#include "kadans/model/kinematics.h"

namespace kadans {

inline constexpr double gravity_of_balance_m_s2 = 9.81;
inline constexpr double lowest_com_m = 0.1;  // over the feet's frames; a robot does not stand below this
inline constexpr double moment_s = 0.001;    // how far ahead velocities are computed

class BodyAhead {
 public:
  // The feet are the links that the options left_foot and right_foot name. Throws OptionError. Keeps a reference to the
  // model.
  explicit BodyAhead(const ObjectSetup& setup);

  // Puts the base's origin at 0 and turns the base by `upright` and by its rotation in ahead_s.
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

// Where the centre of mass of a robot on two feet is and where it is going, for the control objects that balance the
// robot. Both are relative to the middle between the feet's frames.
//
// The divergent component of motion is where the robot's pendulum is going (Hof 2008, Human Movement Science 27(1);
// Englsberger et al. 2015, IEEE T-RO 31(2)): xi = c + v / w0, w0 = sqrt(g / c_z). c is the centre of mass, v its
// velocity. The robot stays up while xi can be kept over the soles. To push xi back, the centre of pressure has to lie
// beyond xi.
//
// The velocity is a difference over a millisecond (body_ahead.h). The feet are assumed to stand flat.
//
// Everything is in the heading frame: x forward along the ground where the base points, y left, z up.
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <array>
#include <cstddef>

#include "body_ahead.h"

namespace kadans {

inline constexpr double standing_share_per_s = 5;  // how fast a balance object's share of torque may change

class Standing {
 public:
  // The feet are the links that the options left_foot and right_foot name. Throws OptionError. Keeps a reference to the
  // model.
  explicit Standing(const ObjectSetup& setup) : body_(setup) {}

  // False when the robot does not stand, or a measurement is not finite.
  bool update(const ControlInput& input) noexcept;

  const Vec3& com_m() const noexcept { return com_m_; }
  const Vec3& velocity_m_s() const noexcept { return velocity_m_s_; }  // of the centre of mass
  double dcm_x_m() const noexcept { return dcm_x_m_; }
  double dcm_y_m() const noexcept { return dcm_y_m_; }
  const std::array<std::size_t, 2>& feet() const noexcept { return body_.feet(); }  // links, left and right
  // As of the last update, the base's origin at 0.
  const Kinematics& kinematics() const noexcept { return body_.kinematics(); }

 private:
  Vec3 com_over_feet(const ControlInput& input, double ahead_s) noexcept;

  BodyAhead body_;
  Vec3 com_m_{}, velocity_m_s_{};
  double dcm_x_m_ = 0, dcm_y_m_ = 0;
};

}  // namespace kadans

// Position and velocity of the centre of mass relative to each foot: the measurements that balance laws use.
//
// Everything is in the heading frame: x points forward along the ground, y left, z up. Forward is where the base points
// now, or where it pointed at keep_heading(). The origin is that of the base frame. The velocity is a difference over a
// millisecond (body_ahead.h). A velocity relative to a foot is a velocity over the ground as long as that foot stands.
//
// The divergent component of motion is where the robot's pendulum is going (Hof 2008, Human Movement Science 27(1);
// Englsberger et al. 2015, IEEE T-RO 31(2)): xi = c + v / w0, w0 = sqrt(g / c_z). c is the centre of mass, v its
// velocity.
//
// One owner, the control thread. Only the constructor allocates or throws.
#pragma once

#include <array>
#include <cstddef>

#include "body_ahead.h"

namespace kadans {

class DcmMeasure {
 public:
  struct OverFoot {
    Vec3 foot_m{};        // the foot's frame, from the base's origin
    double toe_up_m = 0;  // how far its x axis rises, per metre: > 0 with the toes up
    Vec3 com_m{}, velocity_m_s{};
    double dcm_x_m = 0, dcm_y_m = 0;
  };

  // The feet are the links that the options left_foot and right_foot name. Throws OptionError.
  explicit DcmMeasure(const ObjectSetup& setup) : body_(setup) {}

  // False when the robot does not stand, or a measurement is not finite.
  [[nodiscard]] bool update(const ControlInput& input) noexcept;

  // keep_heading: x stays where the base points now. follow_heading: x always is where the base points.
  void keep_heading(const ControlInput& input) noexcept;
  void follow_heading() noexcept { keeps_ = false; }
  void pass_state(StateBytes& bytes) noexcept { bytes(keeps_, heading_rad_); }  // all else is measured anew
  double yaw_rad() const noexcept { return yaw_rad_; }                          // of the base in the heading frame

  const OverFoot& over(std::size_t foot) const noexcept { return over_[foot]; }  // 0 left, 1 right
  const Quat& upright() const noexcept { return upright_; }                      // of the base in the heading frame
  const Vec3& com_m() const noexcept { return com_m_; }                          // from the base's origin
  double rate_per_s() const noexcept { return rate_per_s_; }                     // w0

 private:
  double dcm(std::size_t axis, const OverFoot& over) const noexcept;

  BodyAhead body_;
  std::array<OverFoot, 2> over_{};
  Quat upright_{1, 0, 0, 0};
  Vec3 com_m_{};
  double rate_per_s_ = 1;
  bool keeps_ = false;
  double heading_rad_ = 0, yaw_rad_ = 0;
};

}  // namespace kadans

// Where the centre of mass of a robot on two feet is and where it is going: the measurements that balance laws use.
//
// The divergent component of motion is where the robot's pendulum is going (Hof 2008, Human Movement Science 27(1);
// Englsberger et al. 2015, IEEE T-RO 31(2)): xi = c + v / w0, w0 = sqrt(g / c_z). c is the centre of mass, v its
// velocity. The robot stays up while xi can be kept over the soles. To push xi back, the centre of pressure has to lie
// beyond xi.
//
// Everything is in the heading frame: x points forward along the ground, y left, z up.
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

// The links that the options left_foot and right_foot name. Throws OptionError.
std::array<std::size_t, 2> two_feet(const ObjectSetup& setup);

// Where the links and the centre of mass are and how they move, from the filtered joint velocities and the gyro; no
// position is differentiated. The base's origin is at 0 and at rest.
class MovingBody {
 public:
  // Keeps a reference to the model.
  explicit MovingBody(const RobotModel& model) : model_(&model), kinematics_(model) {}

  // `upright` is the base's orientation.
  void update(const ControlInput& input, const Quat& upright) noexcept;

  // As of the last update.
  const Kinematics& kinematics() const noexcept { return kinematics_; }
  const Vec3& com_m() const noexcept { return com_m_; }
  const Vec3& com_velocity_m_s() const noexcept { return com_velocity_m_s_; }
  // Of a link's frame, and of a point of a link, which is given from the base's origin.
  const Vec3& velocity_m_s(std::size_t link) const noexcept { return links_[link].linear_m_s; }
  Vec3 velocity_m_s(std::size_t link, const Vec3& point_m) const noexcept;

 private:
  struct Velocity {
    Vec3 linear_m_s{}, angular_rad_s{};
  };
  void add_up() noexcept;

  const RobotModel* model_;
  Kinematics kinematics_;
  std::array<Velocity, max_joints + 1> links_{};
  Vec3 com_m_{}, com_velocity_m_s_{};
};

inline constexpr double standing_share_per_s = 5;  // how fast a balance object's share of torque may change

// The centre of mass relative to the middle between the feet's frames; forward is where the base points now. The feet
// are assumed to stand flat.
class Standing {
 public:
  // The feet are the links that the options left_foot and right_foot name. Throws OptionError. Keeps a reference to the
  // model.
  explicit Standing(const ObjectSetup& setup) : feet_(two_feet(setup)), body_(setup.model) {}

  // False when the robot does not stand, or a measurement is not finite.
  bool update(const ControlInput& input) noexcept;

  const Vec3& com_m() const noexcept { return com_m_; }
  const Vec3& velocity_m_s() const noexcept { return velocity_m_s_; }  // of the centre of mass
  double dcm_x_m() const noexcept { return dcm_x_m_; }
  double dcm_y_m() const noexcept { return dcm_y_m_; }
  const std::array<std::size_t, 2>& feet() const noexcept { return feet_; }  // links, left and right
  // As of the last update, the base's origin at 0.
  const Kinematics& kinematics() const noexcept { return body_.kinematics(); }

 private:
  std::array<std::size_t, 2> feet_;
  MovingBody body_;
  Vec3 com_m_{}, velocity_m_s_{};
  double dcm_x_m_ = 0, dcm_y_m_ = 0;
};

// The centre of mass relative to each foot. Forward is where the base points now, or where it pointed at
// keep_heading(); the origin is that of the base frame. A velocity relative to a foot is one over the ground as long as
// that foot stands.
class DcmMeasure {
 public:
  struct OverFoot {
    Vec3 foot_m{};         // the foot's frame, from the base's origin
    double toe_up_m = 0;   // how far its x axis rises, per metre: > 0 with the toes up
    double left_up_m = 0;  // likewise its y axis
    double yaw_rad = 0;    // where its toes point
    Vec3 com_m{}, velocity_m_s{};
    double dcm_x_m = 0, dcm_y_m = 0;
  };

  // The feet are the links that the options left_foot and right_foot name. Throws OptionError.
  explicit DcmMeasure(const ObjectSetup& setup) : feet_(two_feet(setup)), body_(setup.model) {}

  // False when the robot does not stand, or a measurement is not finite.
  [[nodiscard]] bool update(const ControlInput& input) noexcept;

  // keep_heading: x stays where the base points now. follow_heading: x always is where the base points.
  void keep_heading(const ControlInput& input) noexcept;
  void turn_heading(double by_rad) noexcept { heading_rad_ += by_rad; }
  void follow_heading() noexcept { keeps_ = false; }
  void pass_state(StateBytes& bytes) noexcept { bytes(keeps_, heading_rad_); }  // all else is measured anew
  double yaw_rad() const noexcept { return yaw_rad_; }                          // of the base in the heading frame

  const OverFoot& over(std::size_t foot) const noexcept { return over_[foot]; }  // 0 left, 1 right
  const Quat& upright() const noexcept { return upright_; }                      // of the base in the heading frame
  const std::array<std::size_t, 2>& feet() const noexcept { return feet_; }      // links, left and right
  const Kinematics& kinematics() const noexcept { return body_.kinematics(); }   // the base's origin at 0
  double rate_per_s() const noexcept { return rate_per_s_; }                     // w0

 private:
  double dcm(std::size_t axis, const OverFoot& over) const noexcept;

  std::array<std::size_t, 2> feet_;
  MovingBody body_;
  std::array<OverFoot, 2> over_{};
  Quat upright_{1, 0, 0, 0};
  double rate_per_s_ = 1;
  bool keeps_ = false;
  double heading_rad_ = 0, yaw_rad_ = 0;
};

}  // namespace kadans

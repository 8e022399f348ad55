// What stands between drives and joints where it is not one drive in the joint's own coordinate: a gear, or a coupling
// of two joints by two drives.
//
// Kinds, names of the settings and signs are those of ros2_control's transmission_interface (SimpleTransmission,
// DifferentialTransmission, FourBarLinkageTransmission). With the reductions n of the actuators (drives) a and of the
// joints j, and the joints' positions x counted from their offsets, the drives stand at
//
//   simple            a1 = na1 nj1 x1
//   differential      a1 = na1 (nj1 x1 + nj2 x2)    a2 = na2 (nj1 x1 - nj2 x2)
//   four_bar_linkage  a1 = na1 nj1 x1               a2 = na2 (x1 + nj2 x2)
//
// So a = C x. Velocities follow the same C, and efforts its transpose, t_joint = C^T t_drive, which keeps the power.
//
// In frames, which number by joint, drive i of a transmission stands where its joint i does.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kadans/signal/frames.h"

namespace kadans {

class Transmission {
 public:
  enum class Kind : std::uint8_t { simple, differential, four_bar_linkage };
  struct Settings {
    Kind kind = Kind::simple;
    std::vector<std::size_t> joints;                              // simple: one; the others: two
    std::vector<std::string> drives;                              // names, one a joint; none: the joints'
    std::vector<double> actuator_reduction{}, joint_reduction{};  // one a joint; none: 1; negative: the other way round
    std::vector<double> joint_offset_rad{};                       // where the drives count from; one a joint, none: 0
  };
  using Pair = std::array<double, 2>;  // of a simple one only the first counts

  // Throws std::invalid_argument with a sentence: wrong counts, a joint or drive named twice, a reduction that is 0 or
  // not within 1e-6..1e6 either way, an offset that is not finite.
  explicit Transmission(const Settings& settings);

  bool coupled() const noexcept { return joints_.size() == 2; }
  const std::vector<std::size_t>& joints() const noexcept { return joints_; }
  const std::vector<std::string>& drives() const noexcept { return drives_; }
  // How fast a drive turns while a joint turns by 1 rad/s and the other stands; and the other way round.
  double drive_per_joint(std::size_t drive, std::size_t joint) const noexcept { return ratio_[drive][joint]; }
  double joint_per_drive(std::size_t joint, std::size_t drive) const noexcept { return inverse_[joint][drive]; }

  Pair drive_position_rad(const Pair& joint_rad) const noexcept;
  Pair joint_position_rad(const Pair& drive_rad) const noexcept;
  Pair drive_velocity_rad_s(const Pair& joint_rad_s) const noexcept { return times(ratio_, joint_rad_s); }
  Pair joint_velocity_rad_s(const Pair& drive_rad_s) const noexcept { return times(inverse_, drive_rad_s); }
  Pair drive_effort_Nm(const Pair& joint_Nm) const noexcept { return transposed_times(inverse_, joint_Nm); }
  Pair joint_effort_Nm(const Pair& drive_Nm) const noexcept { return transposed_times(ratio_, drive_Nm); }

  // Replaces the values of two coupled joints, in a list of all joints' values, by what one of the functions above
  // makes of them.
  template <typename Values>
  void map(Values& values, Pair (Transmission::*how)(const Pair&) const noexcept) const noexcept {
    double &first = values[joints_[0]], &second = values[joints_[1]];
    const Pair mapped = (this->*how)({first, second});
    first = mapped[0];
    second = mapped[1];
  }

  // What is asked of the joints, as what is asked of their drives; the rest of the frame stays. Coupled drives run in
  // one mode. The safety layer lets no others pass than one mode for both joints, or effort for one and off for the
  // other; of what comes past it all the same, the joints' effort alone counts. In impedance mode a drive knows only
  // its own position, so in impedance mode it gets its diagonal entry of C^-T K C^-1. That is exact for a differential
  // between joints of the same stiffness; joints of different stiffness get the mean of both.
  void to_drives(ActuationFrame& frame) const noexcept;
  // The samples' motor position and effort: what the drives measure as what it is at their joints. With `both` sides
  // the position behind the springs, too, for plants whose encoders all sit at the drives; and the other way round.
  enum class Side : bool { motor, both };
  void to_joints(SensorFrame& frame, Side side) const noexcept;
  void to_drives(SensorFrame& frame, Side side) const noexcept;

 private:
  using Matrix = std::array<Pair, 2>;
  template <typename Map>
  void map(SensorFrame& frame, double JointSample::*value, Map&& mapped) const noexcept;
  static Pair times(const Matrix& m, const Pair& x) noexcept {
    return {m[0][0] * x[0] + m[0][1] * x[1], m[1][0] * x[0] + m[1][1] * x[1]};
  }
  static Pair transposed_times(const Matrix& m, const Pair& x) noexcept {
    return {m[0][0] * x[0] + m[1][0] * x[1], m[0][1] * x[0] + m[1][1] * x[1]};
  }

  std::vector<std::size_t> joints_;
  std::vector<std::string> drives_;
  Matrix ratio_{{{1, 0}, {0, 1}}}, inverse_{{{1, 0}, {0, 1}}};  // C and its inverse
  Pair offset_rad_{};
};

// The drives' names, each in its joint's place: the joint's own, where no transmission names another.
std::vector<std::string> drive_names(std::vector<std::string> joints, std::span<const Transmission> transmissions);

// For plants that read drives: the samples of the drives in their joints' places become those of the joints, on both
// sides of the springs: where an encoder sits at the motor alone, position_rad is the motor's too. A coupled joint's
// reading is new when both of its drives were read, and as old as the older of both.
void drives_to_joints(std::span<const Transmission> transmissions, SensorFrame& sensors) noexcept;

}  // namespace kadans

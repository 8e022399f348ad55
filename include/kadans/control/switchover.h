// Switching control sets while the robot moves, without a step in torque.
//
// Each control object that comes in starts from the measured state and the last actuation. There remains a difference
// between the torque that the drive gave in the last tick and the torque that it will give for the new actuation. The
// switchover adds this difference to the new actuation, so that there is no step, and lets it fade away along a
// minimum-jerk curve. This is bumpless transfer by an output offset (Astrom and Hagglund, Advanced PID Control, ISA
// 2006, sec. 13.5), applied to the drive's torque so that it works across modes.
//
// The fade takes fade_s, or longer where a drive's torque would otherwise change by more than step_max per tick. With
// the default values it never takes longer: a change from one torque limit to the other needs 0.19 s. A switch concerns
// only the joints of the sets that come or leave. The others keep what they have, also a fade that is under way.
//
// The torque of a drive in position or velocity mode depends on its gains and limit, and on where the joint will be
// when the drive uses the actuation. This has to be predicted. The measured velocity lags by the filter's delay, so the
// prediction moves it on with the acceleration. In these modes the offset moves the set-point, which costs nothing of
// the torque's range. What remains of a step is the error of this prediction.
//
// One owner, the control thread; nothing here allocates, locks or throws.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kadans/signal/frames.h"

namespace kadans {

// What the control layer has to know of a drive to predict its torque, and to control it.
struct DriveLaw {
  double effort_max_Nm = 0;
  double position_gain_Nm_per_rad = 0;   // of its position mode
  double velocity_gain_Nms_per_rad = 0;  // of its position and velocity modes
  double velocity_delay_s = 0;           // of the joint's measured velocity, behind the true one
  // Of a series elastic drive, for actuator-level objects (control_sets.h).
  double spring_Nm_per_rad = 0;  // 0: none; of a coupled drive from its own side
  double rotor_inertia_kg_m2 = 0;
  // Of the drive of a coupling in this joint's place, seen from its own side; elsewhere as above.
  double own_rotor_inertia_kg_m2 = 0, own_effort_max_Nm = 0;
};

struct SwitchSettings {
  double step_max = 0.02;  // per tick, as a share of a joint's torque limit; > 0
  double fade_s = 0.2;     // > 0
};

class Switchover {
 public:
  // One law per joint. Without laws (tests of single objects) nothing is smoothed.
  explicit Switchover(std::vector<DriveLaw> drives, const SwitchSettings& settings = {});

  // Each tick, first: estimates the acceleration of the joints.
  void observe(const JointStates& joints, double dt_s) noexcept;

  // In the tick that computes the new set for the first time. `before` is the actuation written in this tick, `after`
  // the one computed for the next tick. `touched`: the joints that the switch concerns, one bit each.
  void begin(const JointStates& joints, double dt_s, const ActuationFrame& before, const ActuationFrame& after,
             std::uint64_t touched = ~std::uint64_t{0}) noexcept;
  // Each tick, last: adds what is left of the offset.
  void apply(const JointStates& joints, double dt_s, ActuationFrame& actuation) noexcept;

  bool fading() const noexcept { return remaining_s_ > 0; }
  // The largest step that the last switch would have made without the offset, as a share of the joint's torque limit.
  const double& absorbed_share() const noexcept { return absorbed_share_; }
  void pass_state(auto& bytes) noexcept {
    bytes(remaining_s_, absorbed_share_);
    for (std::size_t joint = 0; joint < drives_.size(); ++joint)
      bytes(velocity_rad_s_[joint], acceleration_rad_s2_[joint], fades_[joint]);
  }

 private:
  struct Foresight {  // where a joint is at the end of this tick and of the next
    double soon_rad, soon_rad_s, later_rad, later_rad_s;
  };
  Foresight foresee(std::size_t joint, const JointState& state, double dt_s) const noexcept;

  std::vector<DriveLaw> drives_;
  SwitchSettings settings_;
  struct Fade {
    double offset_Nm = 0;
    double duration_s = 0, remaining_s = 0;
  };
  double remaining_s_ = 0;  // of the longest fade under way
  double absorbed_share_ = 0;
  std::array<double, max_joints> velocity_rad_s_{}, acceleration_rad_s2_{};  // measured; its change, smoothed
  std::array<Fade, max_joints> fades_{};
};

// The torque that a drive gives for this actuation, before its limit, when the joint is at position_rad with
// velocity_rad_s.
double drive_torque_Nm(const DriveLaw& drive, const JointActuation& actuation, double position_rad,
                       double velocity_rad_s) noexcept;

}  // namespace kadans

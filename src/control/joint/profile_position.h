// A position set-point on each joint, approached as fast as limits of velocity, acceleration and jerk allow, and
// written in position mode with the velocity as feed-forward: type "profile_position". The law is motion_profile.h; the
// target may change while the joint moves.
//
// Set-points  <joint>.position_rad. A duration that is too short for the limits sets the signal late; 0 is the fastest.
// Parameters  the limits; they count from the next set-point on.
// Start       the reference continues from the drive's last set-point in position mode, else from the measured state
//             while the torque from before fades; it comes to rest within the limits.
#pragma once

#include <memory>

#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/motion_profile.h"

namespace kadans {

class ProfileLaw {
 public:
  struct Config {
    double velocity_max_rad_s = 1;
    double acceleration_max_rad_s2 = 10;  // 0.01..10000
    double jerk_max_rad_s3 = 200;         // 0.1..1e6
  };
  struct State {
    double target_rad = 0;
    double reference_rad = 0, reference_velocity_rad_s = 0, reference_acceleration_rad_s2 = 0;
    double effort_Nm = 0;  // the rest of the torque taken over
    bool late = false;     // the last set-point will take longer than it was given
  };
  static constexpr std::uint32_t channels = 1;

  explicit ProfileLaw(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept { return profile_.remaining_s(); }
  bool setpoint_state(std::uint32_t, SetpointState& state) const noexcept {
    const MotionProfile::State& now = profile_.state();
    return state = {now.position, now.velocity, now.acceleration}, true;
  }
  void follow(std::uint32_t, const SetpointState& state) noexcept {
    profile_.set_state({state.value, state.velocity, state.acceleration});
  }
  void pass_state(StateBytes& bytes) noexcept { bytes(state_, profile_, fading_, lowest_rad_, highest_rad_); }

 private:
  MotionProfile::Limits limits() const noexcept;
  void stop_within_limits() noexcept;

  JointAxis axis_;
  Config config_;
  State state_;
  MotionProfile profile_;
  FadingEffort fading_;
  double lowest_rad_ = 0, highest_rad_ = 0;  // the joint's range, widened to where it was at the start
};

std::unique_ptr<ControlObject> make_profile_position(const ObjectSetup& setup);

}  // namespace kadans

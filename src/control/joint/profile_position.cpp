// A position set-point on each joint, approached as fast as limits of velocity, acceleration and jerk allow, and
// written in position mode with the velocity as feed-forward: type "profile_position". The law is motion_profile.h; the
// target may change while the joint moves.
//
// Set-points  <joint>.position_rad. A duration that is too short for the limits sets the signal late; 0 is the fastest.
// Parameters  the limits; they count from the next set-point on.
// Start       the reference continues from the drive's last set-point in position mode, else from the measured state
//             while the torque from before fades; it comes to rest within the limits.
#include <algorithm>
#include <memory>

#include "kadans/control/joint_axis.h"
#include "kadans/control/jointwise.h"
#include "kadans/control/motion_profile.h"
#include "kadans/control/takeover.h"

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
  void start(const Takeover& takeover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept { return profile_.remaining_s(); }
  bool setpoint_state(std::uint32_t, SetpointState& state) const noexcept { return state = profile_.state(), true; }
  void follow(std::uint32_t, const SetpointState& state) noexcept { profile_.set_state(state); }
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

namespace {

constexpr double slowest_rad_s = 0.001;

}  // namespace

void ProfileLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double fastest = std::max(axis_.velocity_max_rad_s, slowest_rad_s);
  tables.tunable("velocity_max_rad_s", "rad/s", slowest_rad_s, fastest, fastest, &c.velocity_max_rad_s,
                 "Bound of the reference's velocity.");
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.01, 10000, 10, &c.acceleration_max_rad_s2,
                 "Bound of its acceleration.");
  tables.tunable("jerk_max_rad_s3", "rad/s3", 0.1, 1e6, 200, &c.jerk_max_rad_s3, "Bound of its jerk.");
  tables.position_setpoint(0, true);
  tables.signal("target_rad", "rad", "Where the motion ends.", &s.target_rad);
  tables.signal("reference_rad", "rad", "Where the joint shall be now.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("reference_acceleration_rad_s2", "rad/s2", "Its acceleration.", &s.reference_acceleration_rad_s2);
  tables.signal("effort_Nm", "Nm", "What is left of the torque taken over.", &s.effort_Nm);
  tables.signal("late", "", "Whether the motion takes longer than it was given.", &s.late);
}

MotionProfile::Limits ProfileLaw::limits() const noexcept {
  return {config_.velocity_max_rad_s, config_.acceleration_max_rad_s2, config_.jerk_max_rad_s3};
}

// A joint that comes in too fast is led back to its limit.
void ProfileLaw::stop_within_limits() noexcept {
  profile_.stop(limits());
  const double inside_rad = std::clamp(profile_.target(), axis_.lower_rad, axis_.upper_rad);
  if (inside_rad != profile_.target()) (void)profile_.move(inside_rad, limits());
}

void ProfileLaw::start(const Takeover& takeover) noexcept {
  const PositionStart before = position_before(takeover);
  state_ = {};
  lowest_rad_ = std::min(axis_.lower_rad, before.position_rad);
  highest_rad_ = std::max(axis_.upper_rad, before.position_rad);
  profile_.set_state({before.position_rad, before.velocity_rad_s, 0});
  stop_within_limits();
  fading_.start(before.effort_Nm);
}

JointActuation ProfileLaw::step(const JointState&, double dt_s) noexcept {
  State& s = state_;
  const SetpointState& reference = profile_.step(dt_s);
  s.target_rad = profile_.target();
  s.reference_rad = std::clamp(reference.value, lowest_rad_, highest_rad_);
  s.reference_velocity_rad_s = reference.velocity;
  s.reference_acceleration_rad_s2 = reference.acceleration;
  s.effort_Nm = fading_.step(dt_s);
  return {.effort_Nm = s.effort_Nm,
          .position_rad = s.reference_rad,
          .velocity_rad_s = s.reference_velocity_rad_s,
          .mode = ActuationMode::position};
}

void ProfileLaw::set_point(std::uint32_t, double value, double duration_s) noexcept {
  state_.late = !profile_.move(value, limits(), duration_s);
}

void ProfileLaw::cancel(std::uint32_t) noexcept { stop_within_limits(); }

std::unique_ptr<ControlObject> make_profile_position(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<ProfileLaw>>(setup);
}

}  // namespace kadans

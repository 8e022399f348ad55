#include "profile_position.h"

#include <algorithm>

#include "kadans/control/jointwise.h"

namespace kadans {
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

void ProfileLaw::start(const Handover& handover) noexcept {
  const PositionStart before = position_before(handover);
  state_ = {};
  lowest_rad_ = std::min(axis_.lower_rad, before.position_rad);
  highest_rad_ = std::max(axis_.upper_rad, before.position_rad);
  profile_.set_state({before.position_rad, before.velocity_rad_s, 0});
  stop_within_limits();
  fading_.start(before.effort_Nm);
}

JointActuation ProfileLaw::step(const JointState&, double dt_s) noexcept {
  State& s = state_;
  const MotionProfile::State& reference = profile_.step(dt_s);
  s.target_rad = profile_.target();
  s.reference_rad = std::clamp(reference.position, lowest_rad_, highest_rad_);
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

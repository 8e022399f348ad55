#include "kadans/control/velocity_reference.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

double fastest_with_way(double way, double acceleration_max, double dt_s) noexcept {
  if (!(way > 0)) return 0;
  const double step = acceleration_max * dt_s;
  return std::sqrt(step * step + 2 * acceleration_max * way) - step;
}

double towards(double from, double to, double step_max) noexcept {
  return from + std::clamp(to - from, -step_max, step_max);
}

}  // namespace

void VelocityRamp::start(double velocity, double duration_s) noexcept {
  *this = {};
  velocity_ = velocity;
  move(0, duration_s);
}

void VelocityRamp::move(double goal, double duration_s) noexcept {
  goal_ = goal;
  asked_acceleration_ = duration_s > 0 ? std::abs(goal - velocity_) / duration_s : 0;
}

double VelocityRamp::step(double dt_s, double acceleration_max, double below, double above) noexcept {
  const double lowest = -fastest_with_way(below, acceleration_max, dt_s);
  const double highest = fastest_with_way(above, acceleration_max, dt_s);
  const bool gentle = asked_acceleration_ > 0 && asked_acceleration_ < acceleration_max;
  const double acceleration = gentle ? asked_acceleration_ : acceleration_max;

  const double wanted = towards(velocity_, goal_, acceleration * dt_s);
  const double allowed = std::clamp(wanted, lowest, highest);
  limited_ = allowed != wanted;
  velocity_ = limited_ ? towards(velocity_, allowed, acceleration_max * dt_s) : wanted;
  remaining_s_ = limited_ ? 0 : std::abs(goal_ - velocity_) / acceleration;
  return velocity_;
}

void VelocityReference::declare(AxisTables& tables) {
  const double fastest = axis_.velocity_max_rad_s;
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.01, 10000, 20, &acceleration_max_rad_s2_,
                 "Bound of the velocity's change.");
  tables.setpoint("velocity_rad_s", "rad/s", -fastest, fastest, "How fast the joint shall move.", 0, false, 0);
  tables.signal("setpoint_rad_s", "rad/s", "Velocity asked for.", &motion_.setpoint_rad_s);
  tables.signal("reference_velocity_rad_s", "rad/s", "Velocity on the way there.", &motion_.velocity_rad_s);
  tables.signal("limited", "", "Whether a limit is in the way.", &motion_.limited);
}

void VelocityReference::take_over(double velocity_rad_s, double effort_Nm) noexcept {
  motion_ = {};
  ramp_.start(velocity_rad_s, takeover_stop_s);
  fading_.start(effort_Nm);
}

double VelocityReference::advance(double dt_s, double below_rad, double above_rad) noexcept {
  motion_.velocity_rad_s = ramp_.step(dt_s, acceleration_max_rad_s2_, below_rad, above_rad);
  motion_.setpoint_rad_s = ramp_.goal();
  motion_.limited = ramp_.limited();
  return motion_.velocity_rad_s;
}

}  // namespace kadans

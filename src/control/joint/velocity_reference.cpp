#include "kadans/control/velocity_reference.h"

namespace kadans {

void VelocityReference::declare(AxisTables& tables) {
  const double fastest = axis_.velocity_max_rad_s;
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.01, 10000, 20, &acceleration_max_rad_s2_,
                 "Bound of the velocity's change.");
  tables.setpoint("velocity_rad_s", "rad/s", -fastest, fastest, "How fast the joint shall move.", 0);
  tables.signal("setpoint_rad_s", "rad/s", "Velocity asked for.", &motion_.setpoint_rad_s);
  tables.signal("reference_velocity_rad_s", "rad/s", "Velocity on the way there.", &motion_.velocity_rad_s);
  tables.signal("limited", "", "Whether a limit is in the way.", &motion_.limited);
}

void VelocityReference::take_over(double velocity_rad_s, double effort_Nm) noexcept {
  motion_ = {};
  ramp_.start(velocity_rad_s, handover_stop_s);
  fading_.start(effort_Nm);
}

double VelocityReference::advance(double dt_s, double below_rad, double above_rad) noexcept {
  motion_.velocity_rad_s = ramp_.step(dt_s, acceleration_max_rad_s2_, below_rad, above_rad);
  motion_.setpoint_rad_s = ramp_.goal();
  motion_.limited = ramp_.limited();
  return motion_.velocity_rad_s;
}

}  // namespace kadans

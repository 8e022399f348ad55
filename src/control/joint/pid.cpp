#include "kadans/control/pid.h"

#include <algorithm>
#include <numbers>

namespace kadans {

void Pid::start(double position_rad, double velocity_rad_s, double effort_Nm,
                double reference_velocity_rad_s) noexcept {
  const Config& c = config_;
  state_ = {};
  state_.reference_rad = position_rad;
  state_.reference_velocity_rad_s = reference_velocity_rad_s;
  state_.velocity_rad_s = velocity_rad_s;
  const double damping_Nm = c.kd_Nms_per_rad * (c.velocity_weight * reference_velocity_rad_s - velocity_rad_s);
  const double wanted_Nm = effort_Nm - c.feedforward_Nm - damping_Nm;
  state_.integral_Nm = std::clamp(wanted_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  state_.effort_Nm = effort_Nm;
}

double Pid::step(double reference_rad, double reference_velocity_rad_s, double position_rad, double velocity_rad_s,
                 double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  s.reference_rad = reference_rad;
  s.reference_velocity_rad_s = reference_velocity_rad_s;
  s.error_rad = reference_rad - position_rad;

  if (c.kd_cutoff_Hz > 0) {  // first-order low pass by backward differences: stable for every cut-off
    const double rate = 2 * std::numbers::pi * c.kd_cutoff_Hz * dt_s;
    s.velocity_rad_s += rate / (1 + rate) * (velocity_rad_s - s.velocity_rad_s);
  } else {
    s.velocity_rad_s = velocity_rad_s;
  }

  const double unlimited_Nm = c.feedforward_Nm + c.kp_Nm_per_rad * s.error_rad + s.integral_Nm +
                              c.kd_Nms_per_rad * (c.velocity_weight * reference_velocity_rad_s - s.velocity_rad_s);
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;

  const double growth_Nm = c.ki_Nm_per_rads * s.error_rad * dt_s;
  const bool winds_up = s.saturated && growth_Nm * unlimited_Nm > 0;
  if (!winds_up) s.integral_Nm = std::clamp(s.integral_Nm + growth_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  return s.effort_Nm;
}

}  // namespace kadans

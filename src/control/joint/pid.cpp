#include "kadans/control/pid.h"

#include <algorithm>

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

}  // namespace kadans

#include "written_watch.h"

#include <algorithm>
#include <cmath>

namespace kadans::failures {
namespace {

bool at_most(double value, double most) {
  return std::abs(value) <= most * (1 + WrittenWatch::tolerance) + WrittenWatch::tolerance;
}

double effort_rate_Nm_s(const JointLimits& limits) {  // as settings.h says
  return limits.effort_rate_max_Nm_s > 0 ? limits.effort_rate_max_Nm_s : 1000 * limits.effort_max_Nm;
}
double power_W(const JointLimits& limits) {
  return limits.power_max_W > 0 ? limits.power_max_W : limits.effort_max_Nm * limits.velocity_max_rad_s;
}

}  // namespace

bool WrittenWatch::brakes(const Seen& seen) {
  const double effort_Nm = seen.written.effort_Nm, velocity_rad_s = seen.state.velocity_rad_s;
  return effort_Nm * velocity_rad_s <= 0 && at_most(effort_Nm, seen.damping_Nms_per_rad * std::abs(velocity_rad_s));
}

bool WrittenWatch::within_rate(const Seen& seen) {
  const double effort_Nm = seen.written.effort_Nm;
  if (at_most(effort_Nm - seen.last_Nm, effort_rate_Nm_s(seen.limits) * seen.dt_s)) return true;
  const bool less = effort_Nm * seen.last_Nm >= 0 && std::abs(effort_Nm) <= std::abs(seen.last_Nm);
  const double beyond_rad = std::max(seen.state.position_rad - seen.limits.upper_rad, 0.0) +
                            std::min(seen.state.position_rad - seen.limits.lower_rad, 0.0);
  const bool spring =
      effort_Nm * beyond_rad < 0 && at_most(effort_Nm, seen.stiffness_Nm_per_rad * std::abs(beyond_rad));
  return less || spring || brakes(seen);
}

const char* WrittenWatch::wrong_with(const Seen& seen) {
  const JointActuation& a = seen.written;
  const JointLimits& most = seen.limits;
  const double position_rad = seen.state.position_rad;
  if (!std::isfinite(a.effort_Nm) || !std::isfinite(a.position_rad) || !std::isfinite(a.velocity_rad_s)) {
    return "not finite";
  }
  const bool no_torque = a.mode == ActuationMode::off && a.effort_Nm == 0;
  if (most.effort_max_Nm == 0 || seen.level == SafetyLevel::off) return no_torque ? nullptr : "torque while off";
  if (a.mode == ActuationMode::off) return no_torque ? nullptr : "torque in mode off";
  if (seen.level == SafetyLevel::damp) {
    return a.mode == ActuationMode::effort && brakes(seen) ? nullptr : "more than damping while damped";
  }
  if (!at_most(a.effort_Nm, most.effort_max_Nm)) return "too much torque";
  if (!at_most(a.effort_Nm * seen.state.velocity_rad_s, power_W(most))) return "too much power";
  if (!within_rate(seen)) return "torque changes too fast";
  const bool out = (position_rad > most.upper_rad && a.effort_Nm > tolerance) ||
                   (position_rad < most.lower_rad && a.effort_Nm < -tolerance);
  if (out && !brakes(seen)) return "pushes into its stop";
  if (a.mode == ActuationMode::effort) return nullptr;
  if (!at_most(a.velocity_rad_s, most.velocity_max_rad_s)) return "too high a speed asked";
  const bool onward = (position_rad >= most.upper_rad && a.velocity_rad_s > 0) ||
                      (position_rad <= most.lower_rad && a.velocity_rad_s < 0);
  if (onward) return "speed asked into its stop";
  const bool within = a.position_rad >= most.lower_rad && a.position_rad <= most.upper_rad;
  return a.mode == ActuationMode::velocity || within ? nullptr : "a position asked beyond its limits";
}

void WrittenWatch::look(std::uint64_t tick, double dt_s, const ActuationFrame& written, const JointStates& measured,
                        const Safety& safety) {
  const SafetySettings& settings = safety.settings();
  for (std::size_t i = 0; i < last_Nm_.size(); ++i) {
    const Seen seen{written.joints[i],
                    measured.joints[i],
                    settings.joints[i],
                    safety.joint_level(i),
                    last_Nm_[i],
                    dt_s,
                    settings.damping_Nms_per_rad,
                    settings.soft_stop.stiffness_Nm_per_rad};
    const char* wrong = wrong_with(seen);
    last_Nm_[i] = written.joints[i].effort_Nm;
    if (wrong != nullptr && broken_.empty()) {
      broken_ = std::string(wrong) + ": " + model_.joints[i].name + " in tick " + std::to_string(tick);
    }
  }
}

}  // namespace kadans::failures

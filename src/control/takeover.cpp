#include "kadans/control/takeover.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double stop_shortest_s = 0.02;  // close to the joint's limit
constexpr double resting_rad_s = 1e-6;

}  // namespace

double effort_before_Nm(const Takeover& takeover) noexcept {
  switch (takeover.last.mode) {
    case ActuationMode::off:
      return 0;
    case ActuationMode::effort:
      return takeover.last.effort_Nm;
    case ActuationMode::position:
    case ActuationMode::velocity:
    case ActuationMode::impedance:
      return takeover.state.effort_Nm;
  }
  return 0;
}

PositionStart position_before(const Takeover& takeover) noexcept {
  const auto& [state, last, dt_s] = takeover;
  const double ahead_rad = state.position_rad + 2 * dt_s * state.velocity_rad_s;
  switch (last.mode) {
    case ActuationMode::off:
      break;
    case ActuationMode::effort:
      return {ahead_rad, state.velocity_rad_s, last.effort_Nm};
    case ActuationMode::velocity:
      return {ahead_rad, last.velocity_rad_s, last.effort_Nm};
    case ActuationMode::impedance:  // whose gains are others than the next one's
      return {ahead_rad, state.velocity_rad_s, state.effort_Nm};
    case ActuationMode::position:
      return {last.position_rad + dt_s * last.velocity_rad_s, last.velocity_rad_s, last.effort_Nm};
  }
  return {ahead_rad, state.velocity_rad_s, 0};
}

VelocityStart velocity_before(const Takeover& takeover) noexcept {
  if (takeover.last.mode == ActuationMode::velocity) return {takeover.last.velocity_rad_s, takeover.last.effort_Nm};
  return {takeover.state.velocity_rad_s, effort_before_Nm(takeover)};
}

void continue_motion(MinimumJerk& reference, double position_rad, double velocity_rad_s,
                     const JointAxis& axis) noexcept {
  const double target_rad =
      std::clamp(position_rad + 0.5 * takeover_stop_s * velocity_rad_s, axis.lower_rad, axis.upper_rad);
  const double way_rad = target_rad - position_rad;
  if (std::abs(velocity_rad_s) < resting_rad_s && std::abs(way_rad) < resting_rad_s)
    return reference.reset(position_rad);
  const bool towards = way_rad * velocity_rad_s > 0;
  const double duration_s =
      towards ? std::clamp(2 * way_rad / velocity_rad_s, stop_shortest_s, takeover_stop_s) : takeover_stop_s;
  reference.start(position_rad, velocity_rad_s, target_rad, duration_s);
}

void FadingEffort::start(double effort_Nm) noexcept {
  effort_Nm_.reset(effort_Nm);
  if (effort_Nm != 0) effort_Nm_.move(0, fade_s);
}

}  // namespace kadans

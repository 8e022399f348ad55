#include "kadans/control/switchover.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadans {
namespace {

double limited(const DriveLaw& drive, double torque_Nm) noexcept {
  return std::clamp(torque_Nm, -drive.effort_max_Nm, drive.effort_max_Nm);
}

double faded(double share) noexcept {  // 1 at the beginning, 0 at the end
  const double t = 1 - share;
  return 1 - t * t * t * (10 + t * (-15 + 6 * t));
}
constexpr double fade_slope_max = 1.875;  // in its middle

}  // namespace

double drive_torque_Nm(const DriveLaw& drive, const JointActuation& actuation, double position_rad,
                       double velocity_rad_s) noexcept {
  const double velocity_error_rad_s = actuation.velocity_rad_s - velocity_rad_s;
  const double velocity_Nm = drive.velocity_gain_Nms_per_rad * velocity_error_rad_s;
  switch (actuation.mode) {
    case ActuationMode::off:
      return 0;
    case ActuationMode::effort:
      return actuation.effort_Nm;
    case ActuationMode::velocity:
      return actuation.effort_Nm + velocity_Nm;
    case ActuationMode::position:
      return actuation.effort_Nm + velocity_Nm +
             drive.position_gain_Nm_per_rad * (actuation.position_rad - position_rad);
    case ActuationMode::impedance:
      return actuation.effort_Nm + actuation.damping_Nms_per_rad * velocity_error_rad_s +
             actuation.stiffness_Nm_per_rad * (actuation.position_rad - position_rad);
  }
  return 0;
}

namespace {

// Adds to the torque that the drive will give within its limit, by what the mode has for it.
void shift(const DriveLaw& drive, double offset_Nm, double position_rad, double velocity_rad_s,
           JointActuation& actuation) noexcept {
  const double asked_Nm = drive_torque_Nm(drive, actuation, position_rad, velocity_rad_s);
  const double added_Nm = limited(drive, limited(drive, asked_Nm) + offset_Nm) - asked_Nm;
  if (actuation.mode == ActuationMode::position && drive.position_gain_Nm_per_rad > 0) {
    actuation.position_rad += added_Nm / drive.position_gain_Nm_per_rad;
  } else if (actuation.mode == ActuationMode::velocity && drive.velocity_gain_Nms_per_rad > 0) {
    actuation.velocity_rad_s += added_Nm / drive.velocity_gain_Nms_per_rad;
  } else {
    actuation.effort_Nm += added_Nm;
    if (actuation.mode == ActuationMode::off) actuation.mode = ActuationMode::effort;
  }
}

}  // namespace

Switchover::Switchover(std::vector<DriveLaw> drives, const SwitchSettings& settings)
    : drives_(std::move(drives)), settings_(settings) {}

void Switchover::observe(const JointStates& joints, double dt_s) noexcept {
  constexpr double share = 0.4;  // of the newest difference
  const double rate_per_s = 1 / dt_s;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const double change_rad_s2 = (joints.joints[i].velocity_rad_s - velocity_rad_s_[i]) * rate_per_s;
    velocity_rad_s_[i] = joints.joints[i].velocity_rad_s;
    acceleration_rad_s2_[i] += share * (change_rad_s2 - acceleration_rad_s2_[i]);
    if (!std::isfinite(acceleration_rad_s2_[i])) acceleration_rad_s2_[i] = 0;
  }
}

// A drive's servo is implicit in time: it sees the joint at the end of its tick. What was written in this tick is at
// work until the next, what is computed in this one for a tick from there.
Switchover::Foresight Switchover::foresee(std::size_t joint, const JointState& state, double dt_s) const noexcept {
  const double gain_rad_s = dt_s * acceleration_rad_s2_[joint];
  const double soon_rad_s =
      state.velocity_rad_s + drives_[joint].velocity_delay_s * acceleration_rad_s2_[joint] + gain_rad_s;
  const double later_rad_s = soon_rad_s + gain_rad_s;
  const double soon_rad = state.position_rad + dt_s * soon_rad_s;
  return {soon_rad, soon_rad_s, soon_rad + dt_s * later_rad_s, later_rad_s};
}

void Switchover::begin(const JointStates& joints, double dt_s, const ActuationFrame& before,
                       const ActuationFrame& after, std::uint64_t touched) noexcept {
  const auto concerned = [&](std::size_t i) { return (touched >> i & 1U) != 0 && drives_[i].effort_max_Nm > 0; };
  absorbed_share_ = 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (!concerned(i)) continue;
    const DriveLaw& drive = drives_[i];
    const Foresight at = foresee(i, joints.joints[i], dt_s);
    const double was_Nm = drive_torque_Nm(drive, before.joints[i], at.soon_rad, at.soon_rad_s);
    const double will_be_Nm = drive_torque_Nm(drive, after.joints[i], at.later_rad, at.later_rad_s);
    const double difference_Nm = limited(drive, was_Nm) - limited(drive, will_be_Nm);
    // What is not finite is for the safety layer.
    fades_[i].offset_Nm = std::isfinite(difference_Nm) ? difference_Nm : 0;
    absorbed_share_ = std::max(absorbed_share_, std::abs(fades_[i].offset_Nm) / drive.effort_max_Nm);
  }
  const double duration_s = std::max(settings_.fade_s, fade_slope_max * absorbed_share_ / settings_.step_max * dt_s);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (concerned(i)) fades_[i].duration_s = fades_[i].remaining_s = duration_s;
  }
  remaining_s_ = std::max(remaining_s_, duration_s);
}

void Switchover::apply(const JointStates& joints, double dt_s, ActuationFrame& actuation) noexcept {
  if (!fading()) return;
  const auto shorter = [dt_s](double remaining_s) { return remaining_s <= 1.5 * dt_s ? 0 : remaining_s - dt_s; };
  double share = 0, left = 0;  // of the joint before: most are alike
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    Fade& fade = fades_[i];
    if (!(fade.remaining_s > 0)) continue;
    const double share_left = fade.remaining_s / fade.duration_s;
    if (share_left != share) left = faded(share_left);
    share = share_left;
    const Foresight at = foresee(i, joints.joints[i], dt_s);
    shift(drives_[i], left * fade.offset_Nm, at.later_rad, at.later_rad_s, actuation.joints[i]);
    fade.remaining_s = shorter(fade.remaining_s);
  }
  remaining_s_ = shorter(remaining_s_);
}

}  // namespace kadans

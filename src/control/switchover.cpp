#include "kadans/control/switchover.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kadans {
namespace {

double limited(const DriveLaw& drive, double torque_Nm) noexcept {
  return std::clamp(torque_Nm, -drive.effort_max_Nm, drive.effort_max_Nm);
}

// In effort mode the torque is limited before the offset is added; a drive limits its own modes by itself.
double torque_of(const DriveLaw& drive, const JointActuation& actuation, double position_rad,
                 double velocity_rad_s) noexcept {
  const double torque_Nm = drive_torque_Nm(drive, actuation, position_rad, velocity_rad_s);
  return actuation.mode == ActuationMode::effort ? limited(drive, torque_Nm) : torque_Nm;
}

double fade(double share) noexcept {  // 1 at the beginning, 0 at the end
  const double t = 1 - share;
  return 1 - t * t * t * (10 + t * (-15 + 6 * t));
}

}  // namespace

double drive_torque_Nm(const DriveLaw& drive, const JointActuation& actuation, double position_rad,
                       double velocity_rad_s) noexcept {
  const double velocity_Nm = drive.velocity_gain_Nms_per_rad * (actuation.velocity_rad_s - velocity_rad_s);
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
  }
  return 0;
}

Switchover::Switchover(std::vector<DriveLaw> drives, double fade_s, double velocity_delay_s)
    : drives_(std::move(drives)), fade_s_(fade_s), velocity_delay_s_(velocity_delay_s) {}

void Switchover::observe(const JointStates& joints, double dt_s) noexcept {
  constexpr double share = 0.4;  // of the newest difference
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const double change_rad_s2 = (joints.joints[i].velocity_rad_s - velocity_rad_s_[i]) / dt_s;
    velocity_rad_s_[i] = joints.joints[i].velocity_rad_s;
    acceleration_rad_s2_[i] += share * (change_rad_s2 - acceleration_rad_s2_[i]);
    if (!std::isfinite(acceleration_rad_s2_[i])) acceleration_rad_s2_[i] = 0;
  }
}

void Switchover::begin(const JointStates& joints, double dt_s, const ActuationFrame& before,
                       const ActuationFrame& after) noexcept {
  absorbed_share_ = 0;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const DriveLaw& drive = drives_[i];
    if (drive.effort_max_Nm <= 0) continue;
    // A drive's servo is implicit in time: it sees the joint at the end of its tick. The old actuation is at work until
    // the next tick, the new one for a tick from there.
    const JointState& joint = joints.joints[i];
    const double gain_rad_s = dt_s * acceleration_rad_s2_[i];
    const double soon_rad_s = joint.velocity_rad_s + velocity_delay_s_ * acceleration_rad_s2_[i] + gain_rad_s;
    const double later_rad_s = soon_rad_s + gain_rad_s;
    const double soon_rad = joint.position_rad + dt_s * soon_rad_s;
    const double later_rad = soon_rad + dt_s * later_rad_s;
    const double was_Nm = limited(drive, drive_torque_Nm(drive, before.joints[i], soon_rad, soon_rad_s));
    const double will_be_Nm = torque_of(drive, after.joints[i], later_rad, later_rad_s);
    const double difference_Nm = was_Nm - will_be_Nm;
    offset_Nm_[i] = std::isfinite(difference_Nm) ? difference_Nm : 0;  // what is not finite is for the safety layer
    absorbed_share_ = std::max(absorbed_share_, std::abs(offset_Nm_[i]) / drive.effort_max_Nm);
  }
  remaining_s_ = fade_s_;
}

void Switchover::shift(const DriveLaw& drive, double offset_Nm, JointActuation& actuation) const noexcept {
  if (actuation.mode == ActuationMode::position && drive.position_gain_Nm_per_rad > 0) {
    actuation.position_rad += offset_Nm / drive.position_gain_Nm_per_rad;
  } else if (actuation.mode == ActuationMode::velocity && drive.velocity_gain_Nms_per_rad > 0) {
    actuation.velocity_rad_s += offset_Nm / drive.velocity_gain_Nms_per_rad;
  } else if (actuation.mode == ActuationMode::effort) {
    actuation.effort_Nm = limited(drive, limited(drive, actuation.effort_Nm) + offset_Nm);
  } else {
    actuation.effort_Nm += offset_Nm;
    if (actuation.mode == ActuationMode::off) actuation.mode = ActuationMode::effort;
  }
}

void Switchover::apply(double dt_s, ActuationFrame& actuation) noexcept {
  if (!fading()) return;
  const double left = fade(remaining_s_ / fade_s_);
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (drives_[i].effort_max_Nm > 0) shift(drives_[i], left * offset_Nm_[i], actuation.joints[i]);
  }
  remaining_s_ = remaining_s_ <= 1.5 * dt_s ? 0 : remaining_s_ - dt_s;
}

}  // namespace kadans

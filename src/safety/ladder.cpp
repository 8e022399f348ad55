#include "ladder.h"

#include <algorithm>

namespace kadans {
FaultMask Ladder::update(FaultMask faults, double dt_s, const Reactions& reactions,
                         SafetyLevel Reaction::*rung) noexcept {
  for (double& left_s : left_s_) {
    if (left_s > 0) left_s = std::max(0.0, left_s - dt_s);
  }
  FaultMask fresh = 0;
  for (FaultMask rest = faults; rest != 0; rest &= rest - 1) {
    const FaultCode code = first_of(rest);
    const Reaction& reaction = reactions[static_cast<std::size_t>(code)];
    const auto at = static_cast<std::size_t>(reaction.*rung);
    if (((reported_[at] | latched_faults_) & bit(code)) == 0) fresh |= bit(code);
    reported_[at] |= bit(code);
    left_s_[at] = std::max({left_s_[at], reaction.exit_s, dt_s, 1e-9});
    if (!reaction.latch) continue;
    latched_faults_ |= bit(code);
    latched_ = std::max(latched_, reaction.*rung);
  }
  settle();
  return fresh;
}

void Ladder::latch(SafetyLevel level) noexcept {
  latched_ = std::max(latched_, level);
  settle();
}

void Ladder::settle() noexcept {
  SafetyLevel level = latched_;
  bool idle = latched_ == SafetyLevel::normal && latched_faults_ == 0;
  for (std::size_t at = 0; at < left_s_.size(); ++at) {
    if (left_s_[at] > 0) {
      level = std::max(level, static_cast<SafetyLevel>(at));
      idle = false;
    } else {
      reported_[at] = 0;
    }
  }
  level_ = level;
  idle_ = idle;
}

Reactions default_reactions() noexcept {
  using enum FaultCode;
  using enum SafetyLevel;
  Reactions reactions{};
  const auto set = [&](FaultCode code, const Reaction& reaction) {
    reactions[static_cast<std::size_t>(code)] = reaction;
  };
  for (const FaultCode code : {soft_stop, soft_speed, effort_limit, effort_rate_limit, power_limit, motor_warm}) {
    set(code, {.joint = limited});
  }
  for (const FaultCode code :
       {position_limit, velocity_limit, actuation_not_finite, modes_differ, motor_hot, drive_hot}) {
    set(code, {.joint = damp, .latch = true});
  }
  for (const FaultCode code :
       {sensor_not_finite, sensor_silent, sensor_stuck, sensor_jump, drive_fault, drive_not_enabled, sample_old}) {
    set(code, {.joint = off, .latch = true});
  }
  for (const FaultCode code : {imu_silent, imu_not_finite}) set(code, {.robot = hold, .exit_s = 0.1});
  set(imu_stuck, {.robot = hold, .latch = true});
  set(imu_jump, {.robot = limited});
  for (const FaultCode code :
       {foot_silent, foot_stuck, foot_jump, foot_not_finite, channel_silent, channel_range, channel_not_finite}) {
    set(code, {.robot = limited});
  }
  set(heartbeat_lost, {.robot = hold, .escalate = true, .exit_s = 0.02});
  set(overruns, {.robot = damp, .latch = true});
  set(joints_lost, {.robot = damp, .latch = true});
  set(tilt, {.robot = limited});
  set(fall, {.robot = limited});
  set(supply_low, {.robot = hold, .escalate = true, .exit_s = 0.5});
  set(supply_high, {.robot = damp, .latch = true});
  for (const FaultCode code : {emergency_stop, emergency_input}) {
    set(code, {.robot = damp, .latch = true});  // and off after damp_s; no configuration changes it
  }
  return reactions;
}

}  // namespace kadans

// Finds faults of one joint in every tick: of its sensor, its state, its drive and what is asked of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "estimate/sensor_health.h"
#include "kadans/signal/frames.h"
#include "ladder.h"
#include "settings.h"

namespace kadans {

// Finds faults of one joint in every tick: of its sensor, its state and what is asked of it. It only finds them; the
// ladder reacts.
//
// A reading jumps when it is more than jump_rad further from the last one than twice the speed limit allows in the time
// between them.
//
// A reading is stuck when it stays exactly the same for stuck_ticks readings although the motor moved. Standing still
// alone is no fault, because an encoder of finite resolution repeats its readings. With a spring the motor moves by
// torque / spring while the joint is pressed against something; this part of its way does not count. The rest, smoothed
// because the rotor swings on its spring, is the joint's own way. A rigid drive has no second encoder: there a reading
// is also stuck when what is asked of the motor changes much. What is asked of a joint that damps or is off is not
// done, so it does not count.
//
// One owner, the control thread; nothing here allocates or throws.

// A model of the temperature of a motor's winding, which is not measured: heat in proportion to the torque squared,
// lost through a first-order lag (I2t). At the continuous torque it settles at hot_C.
//
// One owner, the control thread; step neither allocates nor throws.
class ThermalModel {
 public:
  ThermalModel() = default;
  ThermalModel(const ThermalSettings& settings, double continuous_Nm, double time_constant_s) noexcept
      : ambient_C_(settings.ambient_C),
        heating_C_per_Nm2_((settings.hot_C - settings.ambient_C) / (continuous_Nm * continuous_Nm)),
        rate_per_s_(1 / time_constant_s),
        temperature_C_(settings.ambient_C) {}

  // A torque that is not finite counts as 0. dt_s must be well below the time constant.
  void step(double effort_Nm, double dt_s) noexcept {
    const double heat_C = heating_C_per_Nm2_ * effort_Nm * effort_Nm;
    const double settled_C = ambient_C_ + (heat_C < std::numeric_limits<double>::infinity() ? heat_C : 0);
    temperature_C_ += std::min(1.0, rate_per_s_ * dt_s) * (settled_C - temperature_C_);
  }

  const double& temperature_C() const noexcept { return temperature_C_; }
  void pass_state(auto& bytes) noexcept { bytes(temperature_C_); }

 private:
  double ambient_C_ = 0;
  double heating_C_per_Nm2_ = 0;
  double rate_per_s_ = 0;
  double temperature_C_ = 0;
};

class JointWatch {
 public:
  struct Input {
    const JointState& state;
    const JointSample& sample;
    const SensorState& health;
    const JointActuation& asked;
    double written_Nm;  // in the last tick
    bool follows;       // in the last tick the joint did what was asked, within limits
    double dt_s;
    double partner_Nm = 0;  // of the motors, at the joint that it is coupled with
  };
  // How far a torque bends the springs between a joint and its drives, as seen from the joint.
  struct Compliance {
    double own_rad_per_Nm = 0, partner_rad_per_Nm = 0;  // of a torque of its own, and of the joint coupled with it
  };

  JointWatch() = default;
  JointWatch(const SafetySettings& settings, const JointLimits& limits) noexcept;
  // Of a coupled joint, in place of that of a spring of its own.
  void set_compliance(const Compliance& compliance) noexcept { compliance_ = compliance; }

  [[gnu::always_inline]] FaultMask look(const Input& input) noexcept;
  // Value and limit of a fault that look() has just found.
  void describe(const Input& input, Fault& fault) const noexcept;

  const ThermalModel& thermal() const noexcept { return thermal_; }
  // The share of its torque that the winding allows, down to the continuous torque's.
  double derating() const noexcept { return derating_; }
  void pass_state(auto& bytes) noexcept {
    bytes(thermal_, derating_, seen_, reading_rad_, step_rad_, step_max_rad_, since_s_, same_, mean_rad_, motor_rad_,
          asked_, motor_low_rad_, motor_high_rad_, asked_low_, asked_high_);
  }

 private:
  static constexpr double swing_s = 0.05;  // of the smoothing; a rotor of 0.04 kg m2 on 100 Nm/rad swings in 0.13 s
  [[gnu::always_inline]] void look_at_reading(const Input& input, FaultMask& found) noexcept;
  [[gnu::always_inline]] bool stuck(const Input& input) noexcept;
  // What was asked of the motor, as one number that the joint follows: the position in modes that have one, else
  // torque.
  static double demand(const Input& input) noexcept {
    return has_position(input.asked.mode) ? input.asked.position_rad : input.written_Nm;
  }
  // The joint's position by its motor: the motor's position less the spring's deflection by its torque, smoothed.
  double by_motor_rad(const Input& input) noexcept {
    if (!elastic()) return input.sample.motor_position_rad;
    const double partner_Nm = std::isfinite(input.partner_Nm) ? input.partner_Nm : 0;  // its own watch tells of it
    const double deflection_rad =
        compliance_.own_rad_per_Nm * input.sample.motor_effort_Nm + compliance_.partner_rad_per_Nm * partner_Nm;
    mean_rad_ += input.dt_s / (input.dt_s + swing_s) * (input.sample.motor_position_rad - deflection_rad - mean_rad_);
    return mean_rad_;
  }
  bool elastic() const noexcept { return compliance_.own_rad_per_Nm > 0; }
  FaultMask derate() noexcept;

  double lowest_rad_ = 0, highest_rad_ = 0;  // limits with their margins
  double fastest_rad_s_ = 0;
  double jump_rad_ = 0, jump_rad_s_ = 0;
  double stuck_motion_rad_ = 0, stuck_effort_Nm_ = 0;
  Compliance compliance_;
  double warm_C_ = 0, hot_C_ = 0, continuous_share_ = 1;
  double lower_rad_ = 0, upper_rad_ = 0;
  std::uint32_t stuck_ticks_ = 0, silent_ticks_max_ = 0;
  bool passive_ = true;

  ThermalModel thermal_;
  double derating_ = 1;
  bool seen_ = false;                       // there was a reading
  double reading_rad_ = 0;                  // the last one
  double step_rad_ = 0, step_max_rad_ = 0;  // from the one before it, and what was possible
  double since_s_ = 0;                      // since the last one
  std::uint32_t same_ = 0;                  // readings in a row equal to it; what the motor did meanwhile:
  double mean_rad_ = 0;                     // by_motor_rad, smoothed
  double motor_rad_ = 0, asked_ = 0;        // when it was first read
  double motor_low_rad_ = 0, motor_high_rad_ = 0, asked_low_ = 0, asked_high_ = 0;
};

// Here, because it runs for every joint in every tick.
inline FaultMask JointWatch::look(const Input& in) noexcept {
  using enum FaultCode;
  since_s_ += in.dt_s;
  FaultMask found = 0;
  note_if(!in.health.finite, sensor_not_finite, found);
  note_if(!is_finite(in.asked), actuation_not_finite, found);
  note_if(in.health.silent_ticks > silent_ticks_max_ + in.health.period_ticks - 1, sensor_silent, found);
  if (in.health.silent_ticks == 0 && in.health.finite) look_at_reading(in, found);
  if (passive_) return found;  // nothing to take away
  note_if(!(in.state.position_rad >= lowest_rad_ && in.state.position_rad <= highest_rad_), position_limit, found);
  note_if(!(std::abs(in.state.velocity_rad_s) <= fastest_rad_s_), velocity_limit, found);
  // Counts the motor's own torque: a load of the ground on the spring heats nothing.
  thermal_.step(std::max(std::abs(in.written_Nm), std::abs(in.sample.motor_effort_Nm)), in.dt_s);
  derating_ = 1;
  return thermal_.temperature_C() <= warm_C_ ? found : found | derate();
}

inline void JointWatch::look_at_reading(const Input& in, FaultMask& found) noexcept {
  const double position_rad = in.sample.position_rad;
  const bool first = !seen_;
  step_rad_ = position_rad - reading_rad_;
  step_max_rad_ = jump_rad_ + jump_rad_s_ * since_s_;
  reading_rad_ = position_rad;
  since_s_ = 0;
  seen_ = true;
  if (first || step_rad_ != 0) {
    same_ = 0;
    mean_rad_ = position_rad;
    motor_rad_ = by_motor_rad(in);
    asked_ = demand(in);
  }
  if (first) return;
  note_if(!(std::abs(step_rad_) <= step_max_rad_), FaultCode::sensor_jump, found);
  note_if(step_rad_ == 0 && stuck(in), FaultCode::sensor_stuck, found);
}

inline bool JointWatch::stuck(const Input& in) noexcept {
  if (same_ == 0) {
    motor_low_rad_ = motor_high_rad_ = motor_rad_;
    asked_low_ = asked_high_ = asked_;
  }
  const double motor_rad = by_motor_rad(in), asked = demand(in);
  if (!in.follows) asked_low_ = asked_high_ = asked;
  motor_low_rad_ = std::min(motor_low_rad_, motor_rad);
  motor_high_rad_ = std::max(motor_high_rad_, motor_rad);
  asked_low_ = std::min(asked_low_, asked);
  asked_high_ = std::max(asked_high_, asked);
  if (++same_ < stuck_ticks_ || passive_) return false;
  if (motor_high_rad_ - motor_low_rad_ > stuck_motion_rad_) return true;
  if (elastic()) return false;  // the motor's encoder has told all
  const double asked_max = has_position(in.asked.mode) ? stuck_motion_rad_ : stuck_effort_Nm_;
  return asked_high_ - asked_low_ > asked_max;
}

// Finds faults that the drives report: a fault of their own, not enabled, too hot, samples too old; and faults of what
// they have in common: the supply, and the emergency stop's own button. It only finds them; the ladder reacts. A value
// that is not reported (NaN, no time) is no fault, except for a supply that has limits.
//
// One owner, the control thread; nothing here allocates or throws.
class DriveWatch {
 public:
  struct Input {
    const JointSample& sample;
    bool asked;             // what was written in the last tick asks for something other than off
    std::int64_t frame_ns;  // of the sensor frame
    double dt_s;
  };

  FaultMask look(const DriveWatchSettings& settings, const Input& in) noexcept {
    using enum FaultCode;
    const JointSample& sample = in.sample;
    const bool idle = in.asked && sample.drive != DriveState::enabled && sample.drive != DriveState::fault;
    idle_s_ = idle ? idle_s_ + in.dt_s : 0;
    const bool dropped_out = idle && was_enabled_;  // while it was asked: it may not come back by itself
    was_enabled_ = sample.drive == DriveState::enabled;
    FaultMask found = 0;
    note_if(sample.drive == DriveState::fault, drive_fault, found);
    note_if(dropped_out || idle_s_ > settings.enable_s, drive_not_enabled, found);
    note_if(sample.temperature_C >= settings.hot_C, drive_hot, found);
    note_if(sample.time_ns != 0 && age_s(in) > settings.sample_age_max_s, sample_old, found);
    return found;
  }
  // Value, limit and the maker's words of a fault that look() has just found; other faults are not changed.
  void describe(const SafetySettings& settings, const Input& in, Fault& fault) const noexcept;
  void pass_state(auto& bytes) noexcept { bytes(idle_s_, was_enabled_); }

 private:
  static double age_s(const Input& in) noexcept { return seconds_between(in.sample.time_ns, in.frame_ns); }

  double idle_s_ = 0;         // asked for torque, and not enabled
  bool was_enabled_ = false;  // in the last tick
};

class SupplyWatch {
 public:
  explicit SupplyWatch(const SafetySettings& settings) noexcept : settings_(settings.supply) {}

  FaultMask look(const SensorFrame& sensors, double dt_s) noexcept;
  void describe(Fault& fault) const noexcept;
  void pass_state(auto& bytes) noexcept { bytes(supply_V_, low_s_, high_s_); }

 private:
  SupplySettings settings_;
  double supply_V_ = 0;            // of the last frame
  double low_s_ = 0, high_s_ = 0;  // how long it has been too low, too high
};

}  // namespace kadans

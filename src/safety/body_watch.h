// Finds faults of the robot as a whole: of its sensors, of the runtime, and whether it stands or falls.
#pragma once

#include <array>
#include <cstdint>

#include "estimate/sensor_health.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"
#include "ladder.h"
#include "settings.h"

namespace kadans {

// Finds faults of the sensors of the robot as a whole: the inertial measurement unit, the feet, and the sensors that
// its configuration names.
//
// A working sensor has noise. A sensor whose readings all changed for a while, and then repeat for some readings, is
// stuck; a model without noise, which always repeats itself, is not. A sensor that the robot does not have is not
// watched: `imu` of the settings says this for the IMU, the sensor frame's count for the feet.
//
// One owner, the control thread; nothing here allocates or throws.

// Finds a sensor that repeats its reading although it changed before.
class RepeatWatch {
 public:
  // True from the `most`-th reading in a row that equals the one before, if the sensor's readings had changed until
  // then.
  bool same(bool repeated, std::uint32_t most) noexcept {
    if (!repeated) {
      same_ = 0;
      if (changes_ < alive_after) ++changes_;
      return false;
    }
    if (changes_ < alive_after) changes_ = 0;
    if (same_ < most) ++same_;
    return changes_ >= alive_after && same_ >= most;
  }
  std::uint32_t count() const noexcept { return same_; }
  void pass_state(auto& bytes) noexcept { bytes(changes_, same_); }

  static constexpr std::uint32_t alive_after = 50;  // readings in a row that all changed

 private:
  std::uint32_t changes_ = 0, same_ = 0;
};

class ImuWatch {
 public:
  explicit ImuWatch(const SafetySettings& settings) noexcept
      : settings_(settings.sensors), silent_ticks_max_(settings.silent_ticks_max) {}

  FaultMask look(const ImuSample& sample, const SensorState& health) noexcept;
  // Value and limit of a fault that look() has just found.
  void describe(const SensorState& health, Fault& fault) const noexcept;
  void pass_state(auto& bytes) noexcept { bytes(seen_, gyro_rad_s_, acceleration_m_s2_, jump_, jump_max_, repeats_); }

 private:
  SensorWatchSettings settings_;
  std::uint32_t silent_ticks_max_;
  bool seen_ = false;
  Vec3 gyro_rad_s_{}, acceleration_m_s2_{};  // the last reading
  double jump_ = 0, jump_max_ = 0;
  RepeatWatch repeats_;
};

class ChannelWatch {
 public:
  ChannelWatch() = default;
  ChannelWatch(const SafetySettings& settings, const SensorChannel& channel) noexcept
      : min_(channel.min),
        max_(channel.max),
        name_(fault_words(channel.name)),
        silent_ticks_max_(settings.silent_ticks_max) {}

  FaultMask look(const ChannelSample& sample, const SensorState& health) noexcept;
  void describe(const ChannelSample& sample, Fault& fault) const noexcept;

 private:
  double min_ = 0, max_ = 0;
  FaultWords name_{};
  std::uint32_t silent_ticks_max_ = 0;
};

class FootWatch {
 public:
  FootWatch() = default;
  explicit FootWatch(const SafetySettings& settings) noexcept
      : force_max_N_(settings.sensors.foot_force_max_N),
        stuck_ticks_(settings.sensors.foot_stuck_ticks),
        silent_ticks_max_(settings.silent_ticks_max) {}

  FaultMask look(const FootSample& sample, const SensorState& health) noexcept;
  void describe(const SensorState& health, Fault& fault) const noexcept;
  void pass_state(auto& bytes) noexcept { bytes(force_N_, worst_N_, repeats_); }

 private:
  double force_max_N_ = 0;
  std::uint32_t stuck_ticks_ = 0, silent_ticks_max_ = 0;
  std::array<double, sensors_per_foot> force_N_{};
  double worst_N_ = 0;
  RepeatWatch repeats_;
};

// Whether the robot stands, leans, falls or lies.
//
//   upright  Ends when roll, pitch or the rate of turning is beyond its limit for time_s: then the robot falls.
//   falling  Torque is reduced to a share, so that joints give way; impacts are recorded. Ends when the robot turned
//            slower than rest_rate for rest_s: then it lies.
//   fallen   Torque comes back, to get up, as fast as for a joint that damped (recover_s). Ends when the robot has been
//            well within the limits for rest_s. Here only the rate shows another fall, because a robot that gets up is
//            beyond the angles.
//
// The limits are those of small humanoids in the RoboCup leagues: 60 degrees of roll, 45 of pitch, 7 rad/s for 40 ms.
//
// One owner, the control thread; nothing here allocates or throws.
class FallWatch {
 public:
  enum class Phase : std::uint8_t { upright, falling, fallen };

  explicit FallWatch(const SafetySettings& settings) noexcept
      : settings_(settings.fall), tilt_max_rad_(settings.tilt_max_rad), recover_s_(settings.recover_s) {}

  FaultMask look(const BaseStatus& base, const ImuSample& sample, double dt_s) noexcept;
  // Value and limit of a fault that look() has just found.
  void describe(const BaseStatus& base, Fault& fault) const noexcept;

  Phase phase() const noexcept { return phase_; }
  const std::uint32_t& phase_number() const noexcept { return phase_number_; }
  // Share of every torque: 1, except while falling and for a while afterwards.
  double share() const noexcept { return share_; }
  const double& impact_m_s2() const noexcept { return impact_m_s2_; }  // the largest of the last fall
  void pass_state(auto& bytes) noexcept {
    bytes(phase_, phase_number_, share_, for_s_, impact_m_s2_);
    bytes.must(phase_ <= Phase::fallen);
  }

 private:
  bool beyond(const BaseStatus& base, double rate_rad_s) const noexcept;
  void advance(const BaseStatus& base, double rate_rad_s, double dt_s) noexcept;

  FallSettings settings_;
  double tilt_max_rad_, recover_s_;
  Phase phase_ = Phase::upright;
  std::uint32_t phase_number_ = 0;
  double share_ = 1;
  double for_s_ = 0;  // how long the condition that ends the phase has lasted
  double impact_m_s2_ = 0;
};

// Finds faults of the runtime itself: no heartbeat of the behavior engine, and late ticks.
//
// One owner, the control thread; nothing here allocates or throws.
class EngineWatch {
 public:
  explicit EngineWatch(const SafetySettings& settings) noexcept
      : heartbeat_timeout_s_(settings.heartbeat_timeout_s), in_a_row_max_(settings.overruns_in_a_row_max) {}

  // `missed` ticks were skipped before this one. The count of late ticks in a row is kept until a tick comes in time.
  FaultMask look(double heartbeat_age_s, std::uint32_t missed) noexcept {
    using enum FaultCode;
    heartbeat_age_s_ = heartbeat_age_s;
    missed_ = missed;
    missed_ticks_ += missed;
    in_a_row_ = missed > 0 ? in_a_row_ + (in_a_row_ < in_a_row_max_ ? 1 : 0) : 0;
    return bit_if(!(heartbeat_age_s <= heartbeat_timeout_s_), heartbeat_lost) | bit_if(missed > 0, tick_overrun) |
           bit_if(in_a_row_ >= in_a_row_max_, overruns);
  }
  void describe(Fault& fault) const noexcept {
    if (fault.code == FaultCode::tick_overrun) fault.value = missed_;
    if (fault.code == FaultCode::heartbeat_lost) tell(fault, heartbeat_age_s_, heartbeat_timeout_s_);
    if (fault.code == FaultCode::overruns) tell(fault, in_a_row_, in_a_row_max_);
  }
  void clear() noexcept { in_a_row_ = 0; }
  void pass_state(auto& bytes) noexcept { bytes(heartbeat_age_s_, in_a_row_, missed_, missed_ticks_); }

  const std::uint32_t& missed_ticks() const noexcept { return missed_ticks_; }  // since the start

 private:
  double heartbeat_timeout_s_, heartbeat_age_s_ = 0;
  std::uint32_t in_a_row_max_, in_a_row_ = 0;
  std::uint32_t missed_ = 0, missed_ticks_ = 0;
};

}  // namespace kadans

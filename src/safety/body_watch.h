// Finds faults of the sensors of the robot as a whole: the inertial measurement unit, the feet, and the sensors that
// its configuration names.
//
// A working sensor has noise. A sensor whose readings all changed for a while, and then repeat for some readings, is
// stuck; a model without noise, which always repeats itself, is not. A sensor that the robot does not have is not
// watched: `imu` of the settings says this for the IMU, the sensor frame's count for the feet.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <array>
#include <cstdint>

#include "estimate/sensor_health.h"
#include "fault_mask.h"
#include "kadans/signal/frames.h"
#include "settings.h"

namespace kadans {

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

 private:
  double force_max_N_ = 0;
  std::uint32_t stuck_ticks_ = 0, silent_ticks_max_ = 0;
  std::array<double, sensors_per_foot> force_N_{};
  double worst_N_ = 0;
  RepeatWatch repeats_;
};

}  // namespace kadans

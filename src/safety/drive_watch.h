// Finds faults that the drives report: a fault of their own, not enabled, too hot, samples too old; and faults of what
// they have in common: the supply, and the emergency stop's own button. It only finds them; the ladder reacts. A value
// that is not reported (NaN, no time) is no fault, except for a supply that has limits.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <cstdint>

#include "fault_mask.h"
#include "kadans/signal/frames.h"
#include "settings.h"

namespace kadans {

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
    return bit_if(sample.drive == DriveState::fault, drive_fault) |
           bit_if(dropped_out || idle_s_ > settings.enable_s, drive_not_enabled) |
           bit_if(sample.temperature_C >= settings.hot_C, drive_hot) |
           bit_if(sample.time_ns != 0 && age_s(in) > settings.sample_age_max_s, sample_old);
  }
  // Value, limit and the maker's words of a fault that look() has just found; other faults are not changed.
  void describe(const SafetySettings& settings, const Input& in, Fault& fault) const noexcept;

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

 private:
  SupplySettings settings_;
  double supply_V_ = 0;            // of the last frame
  double low_s_ = 0, high_s_ = 0;  // how long it has been too low, too high
};

}  // namespace kadans

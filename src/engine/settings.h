// Periods and bounds of the engines: configuration, not constants.
#pragma once

#include <cmath>
#include <cstdint>

#include "kadans/signal/capacity.h"

namespace kadans {

struct EngineSettings {
  double control_period_s = 0.001;
  double behavior_period_s = 0.01;  // a whole multiple of the control period
  // Wall-clock time that one behavior may take in one tick, in a run on the wall clock; 0: half the behavior period.
  double behavior_time_max_s = 0;
  std::uint32_t commands_per_tick_max = max_transaction;
  double command_age_max_s = 0.1;  // older transactions are refused
  bool joystick = false;           // the joystick is recorded
  bool sight = false;              // what perception sees is recorded

  std::int64_t control_period_ns() const noexcept { return std::llround(control_period_s * 1e9); }
  std::int64_t behavior_time_max_ns() const noexcept {
    return std::llround((behavior_time_max_s > 0 ? behavior_time_max_s : behavior_period_s / 2) * 1e9);
  }
  std::int64_t command_age_max_ns() const noexcept { return std::llround(command_age_max_s * 1e9); }
  // Control ticks in a behavior tick; 0 when the behavior period is no whole multiple of the control period.
  std::uint32_t behavior_divisor() const noexcept {
    const std::int64_t control_ns = control_period_ns(), behavior_ns = std::llround(behavior_period_s * 1e9);
    const bool fits = control_ns > 0 && behavior_ns >= control_ns && behavior_ns % control_ns == 0;
    return fits ? static_cast<std::uint32_t>(behavior_ns / control_ns) : 0;
  }
};

}  // namespace kadans

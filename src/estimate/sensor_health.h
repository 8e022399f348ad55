// What the estimator noticed about the sensors themselves; the safety layer judges it. Plain data, written by the
// control thread once a tick.
#pragma once

#include <array>
#include <cstdint>

#include "kadans/signal/capacity.h"

namespace kadans {

struct SensorState {
  std::uint32_t silent_ticks = 0;  // since the last new reading; 0: there was one in this tick
  std::uint32_t period_ticks = 1;  // it is looked at every so many ticks: up to period_ticks - 1 silent ones are normal
  bool finite = true;              // of the last new reading; what was not finite has not been used

  void pass_state(auto& bytes) noexcept { bytes(silent_ticks, finite); }
};

struct SensorHealth {
  std::uint32_t joint_count = 0;
  std::uint32_t foot_count = 0;
  std::array<SensorState, max_joints> joints{};
  SensorState imu;
  std::array<SensorState, max_feet> feet{};
  std::uint32_t channel_count = 0;
  std::array<SensorState, max_channels> channels{};
};

}  // namespace kadans

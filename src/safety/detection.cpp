#include "detection.h"

#include <cmath>

namespace kadans {

std::uint32_t detection_ticks(FaultCode code, const SafetySettings& settings, double dt_s) noexcept {
  using enum FaultCode;
  const auto ticks = [&](double time_s) { return static_cast<std::uint32_t>(std::ceil(time_s / dt_s - 1e-9)); };
  switch (code) {
    case none:
      return 0;
    case sensor_silent:
    case imu_silent:
    case foot_silent:
    case channel_silent:
      return settings.silent_ticks_max + 1;
    case sensor_stuck:
      return settings.sensors.stuck_ticks + 1;
    case imu_stuck:
      return settings.sensors.imu_stuck_ticks + 1;
    case foot_stuck:
      return settings.sensors.foot_stuck_ticks + 1;
    case heartbeat_lost:
      return ticks(settings.heartbeat_timeout_s) + 1;
    case overruns:
      return settings.overruns_in_a_row_max;
    case drive_not_enabled:
      return ticks(settings.drives.enable_s) + 1;
    case supply_low:
    case supply_high:
      return ticks(settings.supply.time_s) + 1;
    case fall:
      return ticks(settings.fall.time_s) + 1;
    default:
      return 1;
  }
}

}  // namespace kadans

// How soon each fault is found: a promise in ticks, which the tests check. Ticks count from the first one whose
// sensors, actuation or time show the fault; 1 is that tick itself.
//
// clang-format off
//   fault                                              ticks
//   ------------------------------------------------   ------------------------------------------------------------
//   position_limit, velocity_limit                     1, of the estimated state
//   motor_warm, motor_hot                              1, of the thermal model
//   effort_limit, effort_rate_limit, power_limit       1, of the value that would have been written
//   soft_stop, soft_speed, actuation_not_finite        1, of the value that would have been written
//   modes_differ                                       1, of what would have been written
//   sensor_not_finite, imu_not_finite, foot_not_finite 1
//   sensor_jump, imu_jump, foot_jump                   1, of the reading
//   sensor_silent                                      silent_ticks_max + 1, + period of a slow joint - 1
//   imu_silent                                         silent_ticks_max periods of its own + 1
//   foot_silent                                        silent_ticks_max + 1
//   channel_silent                                     silent_ticks_max + 1, + ticks of its period - 1
//   channel_range, channel_not_finite                  1, of the reading
//   sensor_stuck                                       stuck_ticks + 1, once the motor has moved or pulled
//   imu_stuck, foot_stuck                              imu_stuck_ticks + 1, foot_stuck_ticks + 1
//   drive_fault, drive_hot, sample_old                 1, of the sample that says so
//   drive_not_enabled                                  drives.enable_s in ticks + 1, while it is asked for torque
//   supply_low, supply_high                            supply.time_s in ticks + 1
//   emergency_input                                    1
//   emergency_stop                                     1, of the first tick after somebody asked
//   heartbeat_lost                                     heartbeat_timeout_s in ticks + 1
//   tick_overrun                                       1
//   overruns                                           overruns_in_a_row_max
//   tilt                                               1, of the estimated orientation
//   fall                                               fall.time_s in ticks + 1
//   impact                                             1, while falling
//   command_refused, command_old                       1, of the transaction's turn in the queue
//   joints_lost                                        1, of the last joint's rung
// clang-format on
#pragma once

#include <cstdint>

#include "kadans/signal/fault.h"
#include "settings.h"

namespace kadans {

// dt_s: the period of the control engine.
std::uint32_t detection_ticks(FaultCode code, const SafetySettings& settings, double dt_s) noexcept;

}  // namespace kadans

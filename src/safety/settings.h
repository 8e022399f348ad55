// Limits and reactions of the safety layer; every field is a key of the robot's configuration.
#pragma once

#include <cstdint>
#include <vector>

#include "kadans/signal/fault.h"
#include "kadans/signal/sensor_channel.h"
#include "ladder.h"

namespace kadans {

struct JointLimits {
  double lower_rad = 0, upper_rad = 0;
  double velocity_max_rad_s = 0;
  double effort_max_Nm = 0;             // 0: passive, never actuated
  double effort_rate_max_Nm_s = 0;      // of what is asked; 0: effort_max in a millisecond
  double power_max_W = 0;               // |torque * velocity|; 0: effort_max times velocity_max
  double continuous_Nm = 0;             // torque that heats the winding just to thermal.hot_C; 0: 0.6 of effort_max
  double thermal_time_constant_s = 60;  // of the winding
  double spring_Nm_per_rad = 0;         // between motor and joint, or behind the coupled drive in its place; 0: rigid
  double drive_effort_max_Nm = 0, drive_velocity_max_rad_s = 0;  // of the drive in its place, if coupled; 0: none
};

// The zone before a position limit. Torque towards the limit fades to 0 across it; beyond the limit a spring pulls
// back.
struct SoftStopSettings {
  double zone_rad = 0.03;
  double stiffness_Nm_per_rad = 100;
};

// The temperature of a motor's winding follows the square of its torque through a first-order lag (I2t):
// time_constant dT/dt = (hot - ambient) (torque / continuous)^2 - (T - ambient).
struct ThermalSettings {
  double ambient_C = 25;
  double warm_C = 95;  // from here torque is derated, down to the continuous one at hot_C
  double hot_C = 120;
};

struct SensorWatchSettings {
  double jump_rad = 0.01;               // beyond what twice the speed limit allows in the time between two readings
  std::uint32_t stuck_ticks = 25;       // readings exactly the same ...
  double stuck_motion_rad = 0.05;       // ... while the motor moved this far, or was told to,
  double stuck_effort_share = 0.3;      // ... or, without a spring, the torque asked changed by this share of its limit
  bool imu = true;                      // false: the robot has none
  std::uint32_t imu_stuck_ticks = 25;   // readings exactly the same of a sensor whose noise has been seen
  double gyro_step_rad_s = 10;          // from one reading to the next
  double gyro_max_rad_s = 35;           // what it can measure
  double acceleration_max_m_s2 = 2000;  // what it can measure
  std::uint32_t foot_stuck_ticks = 25;
  double foot_force_max_N = 20000;  // what one sensor can measure; below -1 % of it is a fault, too
};

// When a drive's own report is a fault.
struct DriveWatchSettings {
  double enable_s = 0.5;            // how long a drive may take until it is enabled, once it is asked for torque
  double hot_C = 90;                // too hot, by its own sensor
  double sample_age_max_s = 0.025;  // of its sample, when the sensor frame is made
};

struct SupplySettings {
  double lowest_V = 0, highest_V = 0;  // of the drives' supply; 0: not watched
  double time_s = 0.05;                // how long it must last: the start of many motors is no fault
};

struct FallSettings {
  double roll_max_rad = 1.0472;  // falling: beyond roll, pitch or rate for time_s
  double pitch_max_rad = 0.7854;
  double rate_max_rad_s = 7;
  double time_s = 0.04;
  double soft_share = 0.25;       // share of every torque while falling; 1: as usual
  double rest_rate_rad_s = 0.17;  // fallen: turns slower than this for rest_s; then torque is back, to get up
  double rest_s = 0.5;
  double impact_max_m_s2 = 100;  // a larger specific force while falling is recorded as an impact
};

struct SafetySettings {
  std::vector<JointLimits> joints;     // one per joint
  double position_margin_rad = 0.05;   // beyond a limit before it is a fault
  double velocity_margin = 1.5;        // times the limit before it is a fault
  double damping_Nms_per_rad = 2.0;    // of a joint that damps
  double recover_s = 0.5;              // torque of a joint that comes back from damp or off grows in this time
  double heartbeat_timeout_s = 0.1;    // of the behavior engine
  std::uint32_t silent_ticks_max = 5;  // readings missing in a row before a sensor counts as silent
  std::uint32_t overruns_in_a_row_max = 5;
  std::uint32_t joints_lost_max = 4;  // joints that damp or are off by themselves before the robot damps
  double hold_s = 1.0;                // a fault that escalates: hold this long, then damp
  double damp_s = 2.0;                // damp this long, then off
  double tilt_max_rad = 0.6;
  SoftStopSettings soft_stop;
  ThermalSettings thermal;
  SensorWatchSettings sensors;
  DriveWatchSettings drives;
  SupplySettings supply;
  FallSettings fall;
  DriveWords drive_words = nullptr;  // of the plant; nullptr: codes are told as numbers
  Reactions reactions = default_reactions();
  std::vector<SensorChannel> channels{};
  std::vector<std::uint16_t> foot_joints{};  // the joint that carries each foot, for messages; may be empty
};

}  // namespace kadans

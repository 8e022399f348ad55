// How the estimator is set up; defaults suit a small humanoid at 1 kHz.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/signal/frames.h"
#include "kadans/signal/sensor_channel.h"

namespace kadans {

struct EstimateFoot {
  std::string link;
  std::array<Vec3, sensors_per_foot> sensors_m{};  // where the sensors sit, in the link's frame: the sole's corners
  std::string name{};                              // as behaviors know it
};

struct EstimateSettings {
  double velocity_cutoff_Hz = 100;               // Butterworth, second order
  std::vector<double> joint_velocity_cutoff_Hz;  // one per joint; 0, or no vector: velocity_cutoff_Hz
  double accelerometer_gain_per_s = 0.5;         // how fast gravity corrects roll and pitch
  double gyro_bias_gain_per_s2 = 0.05;           // how fast the gyro's bias is learnt
  double gyro_bias_max_rad_s = 0.2;              // no bias is learnt beyond it
  double gravity_tolerance = 0.2;                // | |a| / g - 1 | from which the accelerometer is not used
  double contact_on_N = 8, contact_off_N = 4;    // hysteresis of foot contact
  std::vector<EstimateFoot> feet;
  std::vector<SensorChannel> channels;
  std::vector<double> spring_Nm_per_rad;  // one per joint, of coupled joints the drives in their order; 0: no spring,
                                          // the motor's effort is the joint's torque
  std::uint32_t imu_divisor = 1;          // the IMU has a new reading in at least every n-th tick
  std::vector<std::uint32_t> sample_divisor;  // one per joint: sampled every n-th tick; empty: all every tick

  double cutoff_Hz(std::size_t joint) const noexcept {
    const bool own = joint < joint_velocity_cutoff_Hz.size() && joint_velocity_cutoff_Hz[joint] != 0;
    return own ? joint_velocity_cutoff_Hz[joint] : velocity_cutoff_Hz;
  }
};

}  // namespace kadans

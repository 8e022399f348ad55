// What the robot's sensors would say: the truth, quantised, biased and noisy. Every noise comes from a stream of its
// own, named after the sensor, so that the same seed gives the same run and a new sensor disturbs no other.
//
// Joints: position at the joint and before the spring, each rounded to the encoder's resolution; motor effort.
// IMU: rate and specific force at the IMU's point, in its axes. The acceleration is the change of velocity over the
// whole step, so impacts are in it. Feet: the load of truth.h, at the corners of the sole.
#pragma once

#include <string>
#include <vector>

#include "kadans/plant/modelled_drives.h"
#include "kadans/signal/random.h"
#include "truth.h"

namespace kadans::bullet {

class Sensors {
 public:
  Sensors(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed);

  struct ImuInput {
    btVector3 angular_velocity_rad_s, velocity_m_s;  // of the IMU's point, world axes
    btMatrix3x3 base_to_world;
  };
  // Before the first step dt_s is 0, and the IMU counts as at rest.
  void sample(std::int64_t time_ns, double dt_s, const Drives& drives, const btMultiBody& multibody,
              const ImuInput& imu, const std::vector<FootLoad>& feet);
  const SensorFrame& frame() const noexcept { return frame_; }

 private:
  void sample_joint(std::size_t index, const Drive::State& drive, double position_rad);
  void sample_imu(double dt_s, const ImuInput& imu);
  void sample_foot(std::size_t index, const FootLoad& load);

  std::vector<EncoderSettings> encoders_;
  ImuSettings imu_;
  std::vector<FootSettings> feet_;
  btMatrix3x3 imu_to_base_;
  btVector3 gravity_m_s2_, gyro_bias_rad_s_, accelerometer_bias_m_s2_;
  btVector3 last_velocity_m_s_{0, 0, 0};
  std::vector<RandomStream> joint_noise_, foot_noise_;
  RandomStream imu_noise_;
  ModelledChannels channels_;
  SensorFrame frame_;
};

}  // namespace kadans::bullet

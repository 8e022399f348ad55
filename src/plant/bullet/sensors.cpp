#include "sensors.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "convert.h"

namespace kadans::bullet {
namespace {

btVector3 normal_vector(RandomStream& stream, double deviation) {
  if (deviation == 0) return {0, 0, 0};
  const double x = stream.normal(), y = stream.normal(), z = stream.normal();
  return deviation * btVector3(x, y, z);
}

double read_encoder(const EncoderSettings& encoder, RandomStream& noise, double position_rad) {
  double reading = position_rad;
  if (encoder.noise_rad > 0) reading += encoder.noise_rad * noise.normal();
  if (encoder.resolution_rad > 0) reading = std::round(reading / encoder.resolution_rad) * encoder.resolution_rad;
  return reading;
}

// No device tells more than 24 bits: what they leave out is far below any noise. Rounded as an integer, because gcc 12
// leaves out a conversion to float and back where it takes two numbers at once.
double told(double reading) {
  constexpr std::uint64_t half = std::uint64_t{1} << 28U;  // of the last of 24 bits
  return std::bit_cast<double>((std::bit_cast<std::uint64_t>(reading) + half) & ~(2 * half - 1));
}
Vec3 told(const btVector3& reading) { return {told(reading.x()), told(reading.y()), told(reading.z())}; }

}  // namespace

Sensors::Sensors(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
    : encoders_(settings.encoders),
      imu_(settings.imu),
      feet_(settings.feet),
      imu_to_base_(to_bullet(settings.imu.pose.orientation)),
      gravity_m_s2_(to_bullet(settings.gravity_m_s2)),
      imu_noise_(seed, "plant/imu"),
      channels_(settings.channels, seed) {
  RandomStream bias(seed, "plant/imu_bias");
  gyro_bias_rad_s_ = normal_vector(bias, imu_.gyro_bias_rad_s);
  accelerometer_bias_m_s2_ = normal_vector(bias, imu_.accelerometer_bias_m_s2);
  for (const Joint& joint : model.joints) joint_noise_.emplace_back(seed, "plant/encoder/" + joint.name);
  for (const FootSettings& foot : feet_) foot_noise_.emplace_back(seed, "plant/foot/" + foot.link);
  frame_.joint_count = static_cast<std::uint32_t>(model.joints.size());
  frame_.foot_count = static_cast<std::uint32_t>(feet_.size());
}

void Sensors::sample(std::int64_t time_ns, double dt_s, const Drives& drives, const btMultiBody& multibody,
                     const ImuInput& imu, const std::vector<FootLoad>& feet) {
  frame_.time_ns = time_ns;
  for (std::size_t i = 0; i < drives.size(); ++i) {
    sample_joint(i, drives.state(i), multibody.getJointPos(static_cast<int>(i)));
  }
  drives.map(frame_);
  sample_imu(dt_s, imu);
  for (std::size_t i = 0; i < feet.size(); ++i) sample_foot(i, feet[i]);
  channels_.sample(time_ns);
  channels_.fill(frame_);
}

void Sensors::sample_joint(std::size_t index, const Drive::State& drive, double position_rad) {
  JointSample& sample = frame_.joints[index];
  sample.position_rad = read_encoder(encoders_[index], joint_noise_[index], position_rad);
  sample.motor_position_rad = read_encoder(encoders_[index], joint_noise_[index], drive.rotor_rad);
  sample.motor_effort_Nm = told(drive.motor_torque_Nm);
  ++sample.sequence;
}

void Sensors::sample_imu(double dt_s, const ImuInput& imu) {
  const btMatrix3x3 world_to_imu = (imu.base_to_world * imu_to_base_).transpose();
  btVector3 force = -gravity_m_s2_;
  if (dt_s > 0) force += (imu.velocity_m_s - last_velocity_m_s_) / dt_s;
  last_velocity_m_s_ = imu.velocity_m_s;
  frame_.imu.angular_velocity_rad_s = told(world_to_imu * imu.angular_velocity_rad_s + gyro_bias_rad_s_ +
                                           normal_vector(imu_noise_, imu_.gyro_noise_rad_s));
  frame_.imu.acceleration_m_s2 =
      told(world_to_imu * force + accelerometer_bias_m_s2_ + normal_vector(imu_noise_, imu_.accelerometer_noise_m_s2));
  ++frame_.imu.sequence;
}

void Sensors::sample_foot(std::size_t index, const FootLoad& load) {
  FootSample& sample = frame_.feet[index];
  for (std::size_t i = 0; i < sensors_per_foot; ++i) {
    double force_N = load.pressure_N[i];
    if (feet_[index].noise_N > 0) force_N += feet_[index].noise_N * foot_noise_[index].normal();
    sample.force_N[i] = told(std::max(0.0, force_N));
  }
  ++sample.sequence;
}

}  // namespace kadans::bullet

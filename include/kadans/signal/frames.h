// The frames that cross the seams of the control engine. Plain, fixed-size data: they are copied between threads and
// processes as they are, and alignas(8) makes their layout the same on 32-bit machines, where a double in a struct
// would need only 4. Joints are numbered as in the robot's model; only the first `joint_count` entries count.
//
// A frame is as large as the largest robot; copy_used() copies what counts of it, and leaves the rest of `to` as it is.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kadans/signal/capacity.h"

namespace kadans {

using Vec3 = std::array<double, 3>;  // x, y, z
using Quat = std::array<double, 4>;  // w, x, y, z; rotates body coordinates into world coordinates

// What one joint's sensors say. `sequence` grows by one with each new reading, so silence can be told from standstill.
struct alignas(8) JointSample {
  double position_rad = 0;        // at the joint, behind the gear and the spring
  double motor_position_rad = 0;  // before the spring, reflected to the joint
  double motor_effort_Nm = 0;     // from the motor's current, reflected to the joint
  std::uint32_t sequence = 0;
};

struct alignas(8) ImuSample {
  Vec3 angular_velocity_rad_s{};  // in the base frame
  Vec3 acceleration_m_s2{};       // specific force in the base frame: +9.81 up when at rest
  std::uint32_t sequence = 0;
};

struct alignas(8) FootSample {
  std::array<double, sensors_per_foot> force_N{};  // heel inner, heel outer, toe inner, toe outer; >= 0
  std::uint32_t sequence = 0;
};

// Filled by Plant::read.
struct alignas(8) SensorFrame {
  std::int64_t time_ns = 0;  // of the sampling, on the engine's clock
  std::uint32_t joint_count = 0;
  std::uint32_t foot_count = 0;
  std::array<JointSample, max_joints> joints{};
  ImuSample imu;
  std::array<FootSample, max_feet> feet{};
};

// Estimated from the sensors, each tick.
struct alignas(8) JointState {
  double position_rad = 0;
  double velocity_rad_s = 0;
  double effort_Nm = 0;  // torque at the joint: spring deflection where there is a spring, else the motor's effort
};

struct alignas(8) JointStates {
  std::uint32_t count = 0;
  std::array<JointState, max_joints> joints{};
};

enum class ActuationMode : std::uint8_t { off, effort, position, velocity };

// What a drive is asked for. Which fields count is the mode's matter:
//   off       no torque
//   effort    effort_Nm
//   position  position_rad, velocity_rad_s as feed-forward, effort_Nm added
//   velocity  velocity_rad_s, effort_Nm added
struct alignas(8) JointActuation {
  double effort_Nm = 0;
  double position_rad = 0;
  double velocity_rad_s = 0;
  ActuationMode mode = ActuationMode::off;
};

// Taken by Plant::write.
struct alignas(8) ActuationFrame {
  std::uint32_t joint_count = 0;
  std::array<JointActuation, max_joints> joints{};
};

// The first `count` entries, or all that there are.
template <typename T, std::size_t N>
void copy_first(const std::array<T, N>& from, std::size_t count, std::array<T, N>& to) noexcept {
  std::copy_n(from.begin(), std::min(count, N), to.begin());
}

inline void copy_used(const SensorFrame& from, SensorFrame& to) noexcept {
  to.time_ns = from.time_ns;
  to.joint_count = from.joint_count;
  to.foot_count = from.foot_count;
  copy_first(from.joints, from.joint_count, to.joints);
  to.imu = from.imu;
  copy_first(from.feet, from.foot_count, to.feet);
}

inline void copy_used(const JointStates& from, JointStates& to) noexcept {
  to.count = from.count;
  copy_first(from.joints, from.count, to.joints);
}

inline void copy_used(const ActuationFrame& from, ActuationFrame& to) noexcept {
  to.joint_count = from.joint_count;
  copy_first(from.joints, from.joint_count, to.joints);
}

static_assert(std::is_trivially_copyable_v<SensorFrame> && std::is_trivially_copyable_v<JointStates> &&
              std::is_trivially_copyable_v<ActuationFrame>);
static_assert(sizeof(JointSample) == 32 && sizeof(ImuSample) == 56 && sizeof(FootSample) == 40);
static_assert(sizeof(SensorFrame) == 16 + 32 * max_joints + 56 + 40 * max_feet && offsetof(SensorFrame, joints) == 16 &&
              offsetof(SensorFrame, feet) == 72 + 32 * max_joints);
static_assert(sizeof(JointState) == 24 && sizeof(JointStates) == 8 + 24 * max_joints &&
              offsetof(JointStates, joints) == 8);
static_assert(sizeof(JointActuation) == 32 && offsetof(JointActuation, mode) == 24 &&
              sizeof(ActuationFrame) == 8 + 32 * max_joints && offsetof(ActuationFrame, joints) == 8);

}  // namespace kadans

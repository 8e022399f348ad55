// The frames that cross the seams of the control engine. Plain, fixed-size data: they are copied between threads and
// processes as they are, and alignas(8) makes their layout the same on 32-bit machines, where a double in a struct
// would need only 4. Joints are numbered as in the robot's model; only the first `joint_count` entries count.
//
// A frame is as large as the largest robot; copy_used() copies only the entries that count.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>

#include "kadans/signal/capacity.h"

namespace kadans {

using Vec3 = std::array<double, 3>;  // x, y, z
using Quat = std::array<double, 4>;  // w, x, y, z; rotates body coordinates into world coordinates

inline constexpr std::int64_t ns_per_s = 1'000'000'000;

inline Vec3 cross(const Vec3& a, const Vec3& b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vec3 sum(const Vec3& a, const Vec3& b) noexcept { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 difference(const Vec3& a, const Vec3& b) noexcept { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 scaled(double by, const Vec3& v) noexcept { return {by * v[0], by * v[1], by * v[2]}; }
inline double length(const Vec3& v) noexcept { return std::hypot(v[0], v[1], v[2]); }

// Between two times from outside, which may have any value: the difference wraps around and does not overflow.
inline double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return 1e-9 * static_cast<double>(
                    static_cast<std::int64_t>(static_cast<std::uint64_t>(to_ns) - static_cast<std::uint64_t>(from_ns)));
}

// The state that a drive reports. Only an enabled drive does what it is asked.
enum class DriveState : std::uint8_t { off, ready, enabled, homing, fault };
const char* name(DriveState state) noexcept;

// What one joint's sensors and its drive report. `sequence` grows by one with each new reading, so that silence can be
// told from standstill. Positions and effort of coupled joints (model/transmission.h) are the joints', mapped from what
// their drives measure; state, code, temperature and brake are those of the drive in the joint's place.
struct alignas(8) JointSample {
  double position_rad = 0;        // at the joint, behind the gear and the spring
  double motor_position_rad = 0;  // before the spring, reflected to the joint
  double motor_effort_Nm = 0;     // from the motor's current, reflected to the joint
  std::uint32_t sequence = 0;
  std::uint32_t code = 0;    // the maker's own code for what is wrong with the drive; 0: nothing
  std::int64_t time_ns = 0;  // of the reading, on the frame's clock; 0: the frame's time
  float temperature_C = std::numeric_limits<float>::quiet_NaN();  // of the drive or its motor; NaN: not reported
  DriveState drive = DriveState::enabled;
  bool homed = true;    // its position counts from where the joint's does
  bool braked = false;  // its brake holds the joint
};

struct alignas(8) ImuSample {
  Vec3 angular_velocity_rad_s{};  // in the base frame
  Vec3 acceleration_m_s2{};       // specific force in the base frame: +9.81 up when at rest
  std::uint32_t sequence = 0;
  alignas(8) std::int64_t time_ns = 0;  // of the reading, on the frame's clock; 0: the frame's time
};

struct alignas(8) FootSample {
  std::array<double, sensors_per_foot> force_N{};  // heel inner, heel outer, toe inner, toe outer; >= 0
  std::uint32_t sequence = 0;
};

// Of a sensor that the robot's configuration names (sensor_channel.h).
struct alignas(8) ChannelSample {
  double value = 0;
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
  double supply_V = std::numeric_limits<double>::quiet_NaN();  // of the drives; NaN: nothing measures it
  bool emergency = false;                                      // somebody presses the emergency stop's own button
  std::uint32_t channel_count = 0;
  std::array<ChannelSample, max_channels> channels{};  // in the order of the configuration
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

enum class ActuationMode : std::uint8_t { off, effort, position, velocity, impedance };
const char* name(ActuationMode mode) noexcept;
inline constexpr ActuationMode last_actuation_mode = ActuationMode::impedance;
// Modes in which position_rad counts: the drive leads the joint there itself.
constexpr bool has_position(ActuationMode mode) noexcept {
  return mode == ActuationMode::position || mode == ActuationMode::impedance;
}

// What a drive is asked for. The mode says which fields count:
//   off       no torque
//   effort    effort_Nm
//   position  position_rad, velocity_rad_s as feed-forward, effort_Nm added
//   velocity  velocity_rad_s, effort_Nm added
//   impedance stiffness (position_rad - q) + damping (velocity_rad_s - dq/dt) + effort_Nm, a loop in the drive
struct alignas(8) JointActuation {
  double effort_Nm = 0;
  double position_rad = 0;
  double velocity_rad_s = 0;
  double stiffness_Nm_per_rad = 0;
  double damping_Nms_per_rad = 0;
  ActuationMode mode = ActuationMode::off;
};

inline bool is_finite(const JointActuation& a) noexcept {
  // 0 * NaN and 0 * infinity are NaN.
  return 0 * a.effort_Nm + 0 * a.position_rad + 0 * a.velocity_rad_s + 0 * a.stiffness_Nm_per_rad +
             0 * a.damping_Nms_per_rad ==
         0;
}

// What somebody asks of a drive beside torque. An enabled drive holds the joint, so its brake opens; one that is not
// lets the brake hold. `brake` and `release` move the brake by hand, until the drive is enabled or disabled again.
enum class DriveOrder : std::uint8_t { none, enable, disable, reset, home, brake, release };
inline constexpr DriveOrder last_drive_order = DriveOrder::release;
const char* name(DriveOrder order) noexcept;

// The newest order stands in every frame, since a bus may lose some. The drive carries it out once, when its number has
// changed.
struct DriveRequest {
  DriveOrder order = DriveOrder::none;
  std::uint8_t number = 0;

  // Whether it is an order that was not seen before; `seen` is the number of the last one.
  bool is_new(std::uint8_t& seen) const noexcept {
    return std::exchange(seen, number) != number && order != DriveOrder::none;
  }
};
using DriveRequests = std::array<DriveRequest, max_joints>;

// Taken by Plant::write. The control engine alone writes `drives`.
struct alignas(8) ActuationFrame {
  std::uint32_t joint_count = 0;
  std::array<JointActuation, max_joints> joints{};
  DriveRequests drives{};
};

// Copies the first `count` entries, or all that there are.
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
  to.supply_V = from.supply_V;
  to.emergency = from.emergency;
  to.channel_count = from.channel_count;
  copy_first(from.channels, from.channel_count, to.channels);
}

inline void copy_used(const JointStates& from, JointStates& to) noexcept {
  to.count = from.count;
  copy_first(from.joints, from.count, to.joints);
}

inline void copy_used(const ActuationFrame& from, ActuationFrame& to) noexcept {
  to.joint_count = from.joint_count;
  copy_first(from.joints, from.joint_count, to.joints);
  copy_first(from.drives, from.joint_count, to.drives);
}

static_assert(std::is_trivially_copyable_v<SensorFrame> && std::is_trivially_copyable_v<JointStates> &&
              std::is_trivially_copyable_v<ActuationFrame>);
static_assert(sizeof(JointSample) == 48 && sizeof(ImuSample) == 64 && sizeof(FootSample) == 40);
static_assert(sizeof(SensorFrame) == 16 + 48 * max_joints + 64 + 40 * max_feet + 16 + 16 * max_channels &&
              offsetof(SensorFrame, joints) == 16 && offsetof(SensorFrame, feet) == 80 + 48 * max_joints);
static_assert(sizeof(JointState) == 24 && sizeof(JointStates) == 8 + 24 * max_joints &&
              offsetof(JointStates, joints) == 8);
static_assert(sizeof(JointActuation) == 48 && offsetof(JointActuation, mode) == 40 && sizeof(DriveRequest) == 2 &&
              sizeof(ActuationFrame) == 8 + 50 * max_joints && offsetof(ActuationFrame, joints) == 8);

}  // namespace kadans

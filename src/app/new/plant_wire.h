// The wire of a plant that `kadans new plant` writes: templates of new_plant.cpp, which says what stands for what.
#pragma once

#include <string_view>

namespace kadans {

inline constexpr std::string_view wire_header_template =
    R"(// The wire of "@name@": one datagram to the drives and one back in each tick, of a head and of numbers.
//
//   head     magic, kind, joints, feet, sequence, answered (of the other side's datagrams)
//   asked    for each joint: mode, effort, position, velocity, stiffness, damping
//   sensors  time, for each joint: position, motor's position, motor's effort; IMU: 3 rates, 3 accelerations; 4 a foot
//
// Whoever can reach the bus can send anything: a datagram counts only when its size, its head and all its numbers are as
// they must be.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <kadans/signal/frames.h>

namespace @name@_wire {

enum class Kind : std::uint32_t { hello, asked, sensors, bye };

struct Head {
  std::uint32_t magic = 0, kind = 0, joints = 0, feet = 0;
  std::uint32_t sequence = 0, answered = 0;
};

inline constexpr std::size_t numbers_max = 7 + 6 * kadans::max_joints + kadans::sensors_per_foot * kadans::max_feet;
inline constexpr std::size_t bytes_max = sizeof(Head) + sizeof(double) * numbers_max;
using Bytes = std::span<const std::byte>;
using Buffer = std::array<std::byte, bytes_max + 1>;  // one more: what is too long shows

// They return the bytes to send, in `buffer`.
Bytes encode(const Head& head, const kadans::ActuationFrame& asked, Buffer& buffer) noexcept;
Bytes encode(const Head& head, const kadans::SensorFrame& sensors, Buffer& buffer) noexcept;
Bytes encode(const Head& head, Buffer& buffer) noexcept;  // hello and bye

// False, and nothing changes, for a datagram that is not one of this robot's wire.
[[nodiscard]] bool decode(Bytes datagram, std::uint32_t joints, std::uint32_t feet, Head& head) noexcept;
// Of a datagram of this kind that decode() found good. False, and nothing changes, for numbers that are none.
[[nodiscard]] bool decode(Bytes datagram, const Head& head, kadans::ActuationFrame& asked) noexcept;
[[nodiscard]] bool decode(Bytes datagram, const Head& head, kadans::SensorFrame& sensors) noexcept;

}  // namespace @name@_wire
)";

inline constexpr std::string_view wire_source_template = R"(#include "@name@_wire.h"

#include <cmath>
#include <cstring>

using namespace kadans;

namespace @name@_wire {
namespace {

constexpr std::uint32_t magic = 0x4b440001;

class Writer {
 public:
  Writer(const Head& head, Buffer& buffer) noexcept : buffer_(buffer) {
    Head written = head;
    written.magic = magic;
    std::memcpy(buffer_.data(), &written, sizeof written);
  }
  void operator()(double value) noexcept {
    std::memcpy(buffer_.data() + size_, &value, sizeof value);
    size_ += sizeof value;
  }
  Bytes bytes() const noexcept { return Bytes(buffer_).first(size_); }

 private:
  Buffer& buffer_;
  std::size_t size_ = sizeof(Head);
};

class Reader {
 public:
  explicit Reader(Bytes datagram) noexcept : datagram_(datagram) {}
  double operator()() noexcept {
    double value = 0;
    std::memcpy(&value, datagram_.data() + at_, sizeof value);
    at_ += sizeof value;
    finite_ = finite_ && std::isfinite(value);
    return value;
  }
  bool finite() const noexcept { return finite_; }

 private:
  Bytes datagram_;
  std::size_t at_ = sizeof(Head);
  bool finite_ = true;
};

std::size_t numbers(const Head& head) noexcept {
  switch (static_cast<Kind>(head.kind)) {
    case Kind::asked:
      return 6 * head.joints;
    case Kind::sensors:
      return 7 + 3 * head.joints + sensors_per_foot * head.feet;
    default:
      return 0;
  }
}

}  // namespace

Bytes encode(const Head& head, const ActuationFrame& asked, Buffer& buffer) noexcept {
  Writer write(head, buffer);
  for (std::size_t i = 0; i < head.joints; ++i) {
    const JointActuation& joint = asked.joints[i];
    write(static_cast<double>(joint.mode));
    for (const double value : {joint.effort_Nm, joint.position_rad, joint.velocity_rad_s, joint.stiffness_Nm_per_rad,
                               joint.damping_Nms_per_rad})
      write(value);
  }
  return write.bytes();
}

Bytes encode(const Head& head, const SensorFrame& sensors, Buffer& buffer) noexcept {
  Writer write(head, buffer);
  write(static_cast<double>(sensors.time_ns));
  for (std::size_t i = 0; i < head.joints; ++i) {
    const JointSample& joint = sensors.joints[i];
    for (const double value : {joint.position_rad, joint.motor_position_rad, joint.motor_effort_Nm}) write(value);
  }
  for (const double value : sensors.imu.angular_velocity_rad_s) write(value);
  for (const double value : sensors.imu.acceleration_m_s2) write(value);
  for (std::size_t i = 0; i < head.feet; ++i) {
    for (const double value : sensors.feet[i].force_N) write(value);
  }
  return write.bytes();
}

Bytes encode(const Head& head, Buffer& buffer) noexcept { return Writer(head, buffer).bytes(); }

bool decode(Bytes datagram, std::uint32_t joints, std::uint32_t feet, Head& head) noexcept {
  Head read;
  if (datagram.size() < sizeof read) return false;
  std::memcpy(&read, datagram.data(), sizeof read);
  if (read.magic != magic || read.joints != joints || read.feet != feet) return false;
  if (read.kind > static_cast<std::uint32_t>(Kind::bye)) return false;
  if (datagram.size() != sizeof read + sizeof(double) * numbers(read)) return false;
  head = read;
  return true;
}

bool decode(Bytes datagram, const Head& head, ActuationFrame& asked) noexcept {
  Reader read(datagram);
  ActuationFrame frame;
  frame.joint_count = head.joints;
  for (std::size_t i = 0; i < head.joints; ++i) {
    const double mode = read();
    if (!(mode >= 0 && mode <= static_cast<double>(last_actuation_mode)) || mode != std::floor(mode)) return false;
    frame.joints[i].mode = static_cast<ActuationMode>(mode);
    frame.joints[i].effort_Nm = read();
    frame.joints[i].position_rad = read();
    frame.joints[i].velocity_rad_s = read();
    frame.joints[i].stiffness_Nm_per_rad = read();
    frame.joints[i].damping_Nms_per_rad = read();
  }
  if (read.finite()) asked = frame;
  return read.finite();
}

// A new reading: all counts grow.
bool decode(Bytes datagram, const Head& head, SensorFrame& sensors) noexcept {
  Reader read(datagram);
  SensorFrame frame = sensors;
  const double time_ns = read();
  if (!(time_ns >= 0 && time_ns < 9e18)) return false;
  frame.time_ns = static_cast<std::int64_t>(time_ns);
  frame.joint_count = head.joints;
  frame.foot_count = head.feet;
  for (std::size_t i = 0; i < head.joints; ++i) {
    JointSample& joint = frame.joints[i];
    joint.position_rad = read();
    joint.motor_position_rad = read();
    joint.motor_effort_Nm = read();
    ++joint.sequence;
  }
  for (double& value : frame.imu.angular_velocity_rad_s) value = read();
  for (double& value : frame.imu.acceleration_m_s2) value = read();
  ++frame.imu.sequence;
  for (std::size_t i = 0; i < head.feet; ++i) {
    for (double& value : frame.feet[i].force_N) value = read();
    ++frame.feet[i].sequence;
  }
  if (read.finite()) sensors = frame;
  return read.finite();
}

}  // namespace @name@_wire
)";

}  // namespace kadans

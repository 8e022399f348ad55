#include "wire.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "kadans/signal/state_hash.h"
#include "signal/crc32.h"

namespace kadans {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they stand in memory");

constexpr std::uint32_t magic = 0x504e444bU;  // "KDNP"
constexpr std::size_t sum_bytes = 4, greeting_bytes = 8 + 4 + 4 + wire_robot_bytes;
constexpr std::size_t joint_actuation_bytes = 43, joint_sample_bytes = 47, foot_bytes = 36, sensor_bytes = 12;
constexpr std::size_t before_joints_bytes =
    9 + 52 + 9;  // of sensors: what was answered, IMU, what drives have in common
constexpr std::size_t actuation_mode_at = 40, actuation_order_at = 41, released_at = 8, emergency_at = 69;
constexpr std::size_t sample_drive_at = before_joints_bytes + 44, sample_homed_at = before_joints_bytes + 45,
                      sample_braked_at = before_joints_bytes + 46;

template <typename T>
void put(std::byte*& at, const T& value) noexcept {
  std::memcpy(at, &value, sizeof value);
  at += sizeof value;
}

template <typename T>
void take(const std::byte*& at, T& value) noexcept {
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
}

bool take_bool(const std::byte*& at) noexcept {
  std::uint8_t value = 0;
  take(at, value);
  return value != 0;
}

const std::byte* payload(Bytes datagram) noexcept { return datagram.data() + wire_head_bytes; }

void add_names(StateHash& hash, const std::vector<std::string>& names) {
  hash.add(names.size());
  for (const std::string& name : names) {
    hash.add(name.size());
    for (const char c : name) hash.add(static_cast<unsigned char>(c));
  }
}

bool is_greeting(WireKind kind) noexcept {
  return kind == WireKind::hello || kind == WireKind::welcome || kind == WireKind::refusal;
}

}  // namespace

PlantWire::PlantWire(const PlantLayout& layout) {
  if (layout.joints.size() > max_joints || layout.feet.size() > max_feet || layout.sensors.size() > max_channels)
    throw std::invalid_argument("a plant over the network has at most " + std::to_string(max_joints) + " joints, " +
                                std::to_string(max_feet) + " feet and " + std::to_string(max_channels) + " sensors");
  StateHash hash;
  add_names(hash, layout.joints);
  add_names(hash, layout.feet);
  add_names(hash, layout.sensors);
  layout_ = hash.value();
  greeting_.period_ns = layout.period_ns;
  greeting_.joints = static_cast<std::uint32_t>(layout.joints.size());
  greeting_.feet = static_cast<std::uint32_t>(layout.feet.size());
  sensors_ = static_cast<std::uint32_t>(layout.sensors.size());
  std::copy_n(layout.robot.begin(), std::min(layout.robot.size(), wire_robot_bytes - 1), greeting_.robot.begin());
}

std::size_t PlantWire::length(WireKind kind) const noexcept {
  constexpr std::size_t around = wire_head_bytes + sum_bytes;
  switch (kind) {
    case WireKind::hello:
    case WireKind::welcome:
    case WireKind::refusal:
      return around + greeting_bytes;
    case WireKind::actuation:
      return around + joint_actuation_bytes * greeting_.joints;
    case WireKind::sensors:
      return around + before_joints_bytes + joint_sample_bytes * greeting_.joints + foot_bytes * greeting_.feet +
             sensor_bytes * sensors_;
    case WireKind::bye:
      return around;
    case WireKind::none:
      break;
  }
  return 0;
}

std::byte* PlantWire::put_head(const WireHead& head, Datagram& into) const noexcept {
  std::byte* at = into.data();
  put(at, magic);
  put(at, wire_version);
  put(at, head.kind);
  put(at, head.refusal);
  put(at, layout_);
  put(at, head.session);
  put(at, head.sequence);
  put(at, head.time_ns);
  return at;
}

Bytes PlantWire::seal(Datagram& into, const std::byte* end) noexcept {
  const auto used = static_cast<std::size_t>(end - into.data());
  std::byte* at = into.data() + used;
  put(at, crc32({into.data(), used}));
  return {into.data(), used + sum_bytes};
}

Bytes PlantWire::greet(const WireHead& head, Datagram& into) const noexcept {
  std::byte* at = put_head(head, into);
  put(at, greeting_.period_ns);
  put(at, greeting_.joints);
  put(at, greeting_.feet);
  put(at, greeting_.robot);
  return seal(into, at);
}

Bytes PlantWire::bye(const WireHead& head, Datagram& into) const noexcept { return seal(into, put_head(head, into)); }

Bytes PlantWire::actuation(const WireHead& head, const ActuationFrame& frame, Datagram& into) const noexcept {
  std::byte* at = put_head(head, into);
  for (std::size_t i = 0; i < greeting_.joints; ++i) {
    const JointActuation joint = i < frame.joint_count ? frame.joints[i] : JointActuation{};
    put(at, joint.effort_Nm);
    put(at, joint.position_rad);
    put(at, joint.velocity_rad_s);
    put(at, joint.stiffness_Nm_per_rad);
    put(at, joint.damping_Nms_per_rad);
    put(at, joint.mode);
    const DriveRequest request = i < frame.joint_count ? frame.drives[i] : DriveRequest{};
    put(at, request.order);
    put(at, request.number);
  }
  return seal(into, at);
}

Bytes PlantWire::sensors(const WireHead& head, const SensorsOnWire& more, const SensorFrame& frame,
                         Datagram& into) const noexcept {
  std::byte* at = put_head(head, into);
  put(at, more.answered);
  put(at, static_cast<std::uint8_t>(more.released));
  put(at, frame.imu.angular_velocity_rad_s);
  put(at, frame.imu.acceleration_m_s2);
  put(at, frame.imu.sequence);
  put(at, frame.supply_V);
  put(at, static_cast<std::uint8_t>(frame.emergency));
  for (std::size_t i = 0; i < greeting_.joints; ++i) {
    const JointSample& joint = frame.joints[i];
    put(at, joint.position_rad);
    put(at, joint.motor_position_rad);
    put(at, joint.motor_effort_Nm);
    put(at, joint.sequence);
    put(at, joint.code);
    put(at, joint.time_ns);
    put(at, joint.temperature_C);
    put(at, joint.drive);
    put(at, static_cast<std::uint8_t>(joint.homed));
    put(at, static_cast<std::uint8_t>(joint.braked));
  }
  for (std::size_t i = 0; i < greeting_.feet; ++i) {
    put(at, frame.feet[i].force_N);
    put(at, frame.feet[i].sequence);
  }
  for (std::size_t i = 0; i < sensors_; ++i) {
    put(at, frame.channels[i].value);
    put(at, frame.channels[i].sequence);
  }
  return seal(into, at);
}

PlantWire::Check PlantWire::check(Bytes datagram, WireHead& head) const noexcept {
  if (datagram.size() < wire_head_bytes + sum_bytes || datagram.size() > wire_bytes_max) return Check::garbage;
  const std::byte* at = datagram.data();
  std::uint32_t start = 0, sum = 0;
  std::uint16_t version = 0;
  take(at, start);
  take(at, version);
  take(at, head.kind);
  take(at, head.refusal);
  take(at, head.layout);
  take(at, head.session);
  take(at, head.sequence);
  take(at, head.time_ns);
  const Bytes summed = datagram.first(datagram.size() - sum_bytes);
  at = summed.data() + summed.size();
  take(at, sum);
  if (start != magic || sum != crc32(summed)) return Check::garbage;
  if (is_greeting(head.kind) && datagram.size() != length(head.kind)) return Check::garbage;
  if (version != wire_version) return is_greeting(head.kind) ? Check::other_version : Check::garbage;
  if (head.layout != layout_) return Check::other_layout;
  if (datagram.size() != length(head.kind)) return Check::garbage;
  // Whether each joint's byte is one of a few.
  const auto all_below = [&](std::size_t first, std::size_t step, auto last_good) {
    for (std::size_t i = 0; i < greeting_.joints; ++i) {
      if (payload(datagram)[first + i * step] > static_cast<std::byte>(last_good)) return false;
    }
    return true;
  };
  bool good = true;
  if (head.kind == WireKind::actuation) {
    good = all_below(actuation_mode_at, joint_actuation_bytes, last_actuation_mode) &&
           all_below(actuation_order_at, joint_actuation_bytes, last_drive_order);
  }
  if (head.kind == WireKind::sensors) {
    good = payload(datagram)[released_at] <= std::byte{1} && payload(datagram)[emergency_at] <= std::byte{1} &&
           all_below(sample_drive_at, joint_sample_bytes, DriveState::fault) &&
           all_below(sample_homed_at, joint_sample_bytes, 1) && all_below(sample_braked_at, joint_sample_bytes, 1);
  }
  return good ? Check::good : Check::garbage;
}

WireGreeting PlantWire::greeting_in(Bytes datagram) noexcept {
  WireGreeting greeting;
  const std::byte* at = payload(datagram);
  take(at, greeting.period_ns);
  take(at, greeting.joints);
  take(at, greeting.feet);
  take(at, greeting.robot);
  greeting.robot.back() = 0;
  for (char& c : greeting.robot) {  // it is shown to a person
    if (c != 0 && (c < ' ' || c > '~')) c = '?';
  }
  return greeting;
}

void PlantWire::actuation_in(Bytes datagram, ActuationFrame& frame) const noexcept {
  const std::byte* at = payload(datagram);
  frame.joint_count = greeting_.joints;
  for (std::size_t i = 0; i < greeting_.joints; ++i) {
    JointActuation& joint = frame.joints[i];
    take(at, joint.effort_Nm);
    take(at, joint.position_rad);
    take(at, joint.velocity_rad_s);
    take(at, joint.stiffness_Nm_per_rad);
    take(at, joint.damping_Nms_per_rad);
    take(at, joint.mode);
    take(at, frame.drives[i].order);
    take(at, frame.drives[i].number);
  }
}

SensorsOnWire PlantWire::sensors_in(Bytes datagram, SensorFrame& frame) const noexcept {
  const std::byte* at = payload(datagram);
  SensorsOnWire more;
  take(at, more.answered);
  more.released = take_bool(at);
  frame.joint_count = greeting_.joints;
  frame.foot_count = greeting_.feet;
  take(at, frame.imu.angular_velocity_rad_s);
  take(at, frame.imu.acceleration_m_s2);
  take(at, frame.imu.sequence);
  take(at, frame.supply_V);
  frame.emergency = take_bool(at);
  for (std::size_t i = 0; i < greeting_.joints; ++i) {
    JointSample& joint = frame.joints[i];
    take(at, joint.position_rad);
    take(at, joint.motor_position_rad);
    take(at, joint.motor_effort_Nm);
    take(at, joint.sequence);
    take(at, joint.code);
    take(at, joint.time_ns);
    take(at, joint.temperature_C);
    take(at, joint.drive);
    joint.homed = take_bool(at);
    joint.braked = take_bool(at);
  }
  for (std::size_t i = 0; i < greeting_.feet; ++i) {
    take(at, frame.feet[i].force_N);
    take(at, frame.feet[i].sequence);
  }
  frame.channel_count = sensors_;
  for (std::size_t i = 0; i < sensors_; ++i) {
    take(at, frame.channels[i].value);
    take(at, frame.channels[i].sequence);
  }
  return more;
}

}  // namespace kadans

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

// Puts values one after the other, and takes them again.
struct Put {
  std::byte* at;

  template <typename T>
  void operator()(const T& value) noexcept {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  }
};
struct Take {
  const std::byte* at;

  template <typename T>
  void operator()(T& value) noexcept {
    std::memcpy(&value, at, sizeof value);
    at += sizeof value;
  }
  void operator()(bool& value) noexcept {
    static_assert(sizeof value == 1);
    value = *at++ != std::byte{0};
  }
};

// What stands in a datagram, in this order (wire.h): `each` puts it or takes it.
void each_of_head(auto& each, auto& head) noexcept {
  each(head.kind);
  each(head.refusal);
  each(head.layout);
  each(head.session);
  each(head.sequence);
  each(head.time_ns);
}
void each_of_greeting(auto& each, auto& greeting) noexcept {
  each(greeting.period_ns);
  each(greeting.joints);
  each(greeting.feet);
  each(greeting.robot);
}
void each_of_actuation(auto& each, auto& joint, auto& request) noexcept {
  each(joint.effort_Nm);
  each(joint.position_rad);
  each(joint.velocity_rad_s);
  each(joint.stiffness_Nm_per_rad);
  each(joint.damping_Nms_per_rad);
  each(joint.mode);
  each(request.order);
  each(request.number);
}
void each_of_sensors(auto& each, auto& more, auto& frame, const WireGreeting& counts, std::uint32_t sensors) noexcept {
  each(more.answered);
  each(more.released);
  each(frame.imu.angular_velocity_rad_s);
  each(frame.imu.acceleration_m_s2);
  each(frame.imu.sequence);
  each(frame.supply_V);
  each(frame.emergency);
  for (std::size_t i = 0; i < counts.joints; ++i) {
    auto& joint = frame.joints[i];
    each(joint.position_rad);
    each(joint.motor_position_rad);
    each(joint.motor_effort_Nm);
    each(joint.sequence);
    each(joint.code);
    each(joint.time_ns);
    each(joint.temperature_C);
    each(joint.drive);
    each(joint.homed);
    each(joint.braked);
  }
  for (std::size_t i = 0; i < counts.feet; ++i) {
    each(frame.feet[i].force_N);
    each(frame.feet[i].sequence);
  }
  for (std::size_t i = 0; i < sensors; ++i) {
    each(frame.channels[i].value);
    each(frame.channels[i].sequence);
  }
}

const std::byte* payload(Bytes datagram) noexcept { return datagram.data() + wire_head_bytes; }

void add_names(StateHash& hash, const std::vector<std::string>& names) {
  hash.add(names.size());
  for (const std::string& name : names) hash.add(name);
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
  Put put{into.data()};
  put(magic);
  put(wire_version);
  WireHead own = head;
  own.layout = layout_;
  each_of_head(put, own);
  return put.at;
}

Bytes PlantWire::seal(Datagram& into, const std::byte* end) noexcept {
  const auto used = static_cast<std::size_t>(end - into.data());
  Put{into.data() + used}(crc32({into.data(), used}));
  return {into.data(), used + sum_bytes};
}

Bytes PlantWire::greet(const WireHead& head, Datagram& into) const noexcept {
  Put put{put_head(head, into)};
  each_of_greeting(put, greeting_);
  return seal(into, put.at);
}

Bytes PlantWire::bye(const WireHead& head, Datagram& into) const noexcept { return seal(into, put_head(head, into)); }

Bytes PlantWire::actuation(const WireHead& head, const ActuationFrame& frame, Datagram& into) const noexcept {
  Put put{put_head(head, into)};
  for (std::size_t i = 0; i < greeting_.joints; ++i) {
    const JointActuation joint = i < frame.joint_count ? frame.joints[i] : JointActuation{};
    const DriveRequest request = i < frame.joint_count ? frame.drives[i] : DriveRequest{};
    each_of_actuation(put, joint, request);
  }
  return seal(into, put.at);
}

Bytes PlantWire::sensors(const WireHead& head, const SensorsOnWire& more, const SensorFrame& frame,
                         Datagram& into) const noexcept {
  Put put{put_head(head, into)};
  each_of_sensors(put, more, frame, greeting_, sensors_);
  return seal(into, put.at);
}

PlantWire::Check PlantWire::check(Bytes datagram, WireHead& head) const noexcept {
  if (datagram.size() < wire_head_bytes + sum_bytes || datagram.size() > wire_bytes_max) return Check::garbage;
  Take take{datagram.data()};
  std::uint32_t start = 0, sum = 0;
  std::uint16_t version = 0;
  take(start);
  take(version);
  each_of_head(take, head);
  const Bytes summed = datagram.first(datagram.size() - sum_bytes);
  Take{summed.data() + summed.size()}(sum);
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
  Take take{payload(datagram)};
  each_of_greeting(take, greeting);
  greeting.robot.back() = 0;
  for (char& c : greeting.robot) {  // it is shown to a person
    if (c != 0 && (c < ' ' || c > '~')) c = '?';
  }
  return greeting;
}

void PlantWire::actuation_in(Bytes datagram, ActuationFrame& frame) const noexcept {
  Take take{payload(datagram)};
  frame.joint_count = greeting_.joints;
  for (std::size_t i = 0; i < greeting_.joints; ++i) each_of_actuation(take, frame.joints[i], frame.drives[i]);
}

SensorsOnWire PlantWire::sensors_in(Bytes datagram, SensorFrame& frame) const noexcept {
  Take take{payload(datagram)};
  SensorsOnWire more;
  frame.joint_count = greeting_.joints;
  frame.foot_count = greeting_.feet;
  frame.channel_count = sensors_;
  each_of_sensors(take, more, frame, greeting_, sensors_);
  return more;
}

}  // namespace kadans

// The datagrams between a control engine and a plant on another machine. Little-endian, no padding, one length for each
// kind and robot:
//
//   head      u32 "KDNP", u16 version, u8 kind, u8 refusal, u64 layout, u64 session, u64 sequence, i64 time_ns
//   payload   by kind
//   u32       CRC-32 over all before it
//
// clang-format off
//   kind       from      payload
//   hello      control   greeting: i64 period_ns, u32 joints, u32 feet, 32 characters of the robot's name
//   welcome    plant     greeting
//   refusal    plant     greeting; the head says why
//   actuation  control   a joint: f64 effort_Nm, position_rad, velocity_rad_s, stiffness_Nm_per_rad,
//                        damping_Nms_per_rad, u8 mode, u8 order to its drive, u8 number of the order
//   sensors    plant     u64 answered; u8 released; imu: 6 f64, u32; f64 supply_V; u8 emergency; a joint: 3 f64, u32
//                        sequence, u32 code, i64 time_ns, f32 temperature_C, u8 drive, u8 homed, u8 braked; a foot: 4
//                        f64, u32; a sensor: f64, u32
//   bye        control   none
// clang-format on
//
// `layout` is a hash of the names of joints, feet and sensors in their order, so that different robots refuse each
// other. The control side draws a new `session` at random for each run, so that datagrams of an earlier run are
// refused. `sequence` counts the datagrams of one side from 1. `time_ns` is always the plant's clock: in sensors the
// time of the sampling, in an actuation that of the newest sample that the control side had. `answered` is the sequence
// number of the newest actuation that the plant had when it took the sample. A greeting looks the same in every
// version.
//
// Encoding and decoding neither allocate nor throw. Nothing from outside is used before check().
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kadans/plant/plant.h"
#include "kadans/plant/plant_type.h"
#include "kadans/signal/frames.h"
#include "plant/arrivals.h"

namespace kadans {

// How a plant on another machine is reached, and how long either side goes on without the other. Fields are keys of the
// robot's configuration, plant.udp.
struct UdpSettings {
  std::string peer;                // "host:port" of the plant; "": given on the command line
  double connect_timeout_s = 5;    // how long the control side waits for the plant's answer
  double round_trip_max_s = 0.01;  // readings that answer an actuation older than this are not new
  double watchdog_s = 0.02;        // without an actuation for this long the plant's side damps the joints
  double peer_timeout_s = 1;       // without an actuation for this long it ends the session
  double damping_Nms_per_rad = 2;  // of that watchdog; the robot's safety.damping_Nms_per_rad, no key of its own
};

inline constexpr std::uint16_t wire_version = 3;
inline constexpr std::size_t wire_head_bytes = 40, wire_robot_bytes = 32;
// No datagram is longer than this.
inline constexpr std::size_t wire_bytes_max =
    wire_head_bytes + 9 + 52 + 9 + 47 * max_joints + 36 * max_feet + 12 * max_channels + 4;

enum class WireKind : std::uint8_t { none, hello, welcome, refusal, actuation, sensors, bye };
enum class WireRefusal : std::uint8_t { none, other_version, layout, period, busy };

struct WireHead {
  WireKind kind = WireKind::none;
  WireRefusal refusal = WireRefusal::none;
  std::uint64_t layout = 0;
  std::uint64_t session = 0;
  std::uint64_t sequence = 0;
  std::int64_t time_ns = 0;
};

struct WireGreeting {
  std::int64_t period_ns = 0;
  std::uint32_t joints = 0, feet = 0;
  std::array<char, wire_robot_bytes> robot{};  // the name; 0 after it
};

struct SensorsOnWire {
  std::uint64_t answered = 0;  // sequence of an actuation; 0: none yet
  bool released = false;       // the plant's watchdog damps the joints
};

using Datagram = std::array<std::byte, wire_bytes_max>;
using Bytes = std::span<const std::byte>;

class PlantWire {
 public:
  // Throws std::invalid_argument when there are more joints or feet than frames hold.
  explicit PlantWire(const PlantLayout& layout);

  std::uint64_t layout() const noexcept { return layout_; }
  const WireGreeting& greeting() const noexcept { return greeting_; }

  // Each writes a datagram to `into` and returns the part that it takes.
  Bytes greet(const WireHead& head, Datagram& into) const noexcept;  // hello, welcome, refusal
  Bytes bye(const WireHead& head, Datagram& into) const noexcept;
  Bytes actuation(const WireHead& head, const ActuationFrame& frame, Datagram& into) const noexcept;
  Bytes sensors(const WireHead& head, const SensorsOnWire& more, const SensorFrame& frame,
                Datagram& into) const noexcept;

  // Garbage has a wrong magic number, length or checksum, or an unknown kind, mode or state.
  enum class Check : std::uint8_t { good, garbage, other_version, other_layout };
  Check check(Bytes datagram, WireHead& head) const noexcept;
  // For a datagram that check() found good (a greeting: not garbage).
  static WireGreeting greeting_in(Bytes datagram) noexcept;
  void actuation_in(Bytes datagram, ActuationFrame& frame) const noexcept;
  SensorsOnWire sensors_in(Bytes datagram, SensorFrame& frame) const noexcept;

 private:
  std::size_t length(WireKind kind) const noexcept;  // 0 for WireKind::none
  std::byte* put_head(const WireHead& head, Datagram& into) const noexcept;
  static Bytes seal(Datagram& into, const std::byte* end) noexcept;

  std::uint64_t layout_ = 0;
  WireGreeting greeting_;
  std::uint32_t sensors_ = 0;  // count
};

}  // namespace kadans

// Messages of Xsens' MT protocol, from its Low Level Communication Protocol document:
//
//   FA | FF | message | length | data | checksum
//
// Numbers are big-endian, of floats too. All bytes behind FA add up to 0 modulo 256. A reading, MTData2 (36), is a list
// of items: name (2 bytes), length, value. In MTData (32) of older devices the values follow each other bare.
//
// One bent byte is always found. Several find each other out in 255 of 256 cases only: so a reading must have exactly
// the items that were asked for, and values that the device can measure. Nothing here allocates or throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "kadans/signal/frames.h"
#include "plant/serial/receive_buffer.h"
#include "settings.h"

namespace kadans::imu {

using Octets = std::span<const std::uint8_t>;

inline constexpr std::size_t message_overhead = 5;
inline constexpr std::size_t data_bytes_max = 64;  // nothing longer is asked for
inline constexpr std::size_t mtdata2_bytes = 5 + 15 + 15, mtdata_bytes = 26;
inline constexpr std::uint32_t mtdata_ticks_per_s = 115'200;               // of the older devices' SetPeriod
inline constexpr double acceleration_max_m_s2 = 400, gyro_max_rad_s = 60;  // no device measures more

enum class Message : std::uint8_t {
  req_device_id = 0x00,
  device_id = 0x01,
  set_period = 0x04,
  go_to_measurement = 0x10,
  go_to_config = 0x30,
  mtdata = 0x32,
  mtdata2 = 0x36,
  error = 0x42,
  set_output_configuration = 0xC0,
  set_output_mode = 0xD0,
  set_output_settings = 0xD2,
  set_output_skip_factor = 0xD4,
};

enum Item : std::uint16_t { packet_counter = 0x1020, acceleration = 0x4020, rate_of_turn = 0x8020 };

struct ReceivedMessage {
  std::uint8_t id = 0;
  Octets data;  // valid until the next call to the scanner
};

// Writes a message into `into` and returns its size; 0: it does not fit.
std::size_t write_message(Message id, Octets data, std::span<std::uint8_t> into) noexcept;

// Finds the messages in a stream of bytes that may be anything.
class MessageScanner : public ReceiveBuffer<1024> {
 public:
  bool next(ReceivedMessage& message) noexcept;  // false: no whole message is here
};

struct Reading {
  std::uint16_t counter = 0;                           // grows by one with each, round after 65,535
  Vec3 acceleration_m_s2{}, angular_velocity_rad_s{};  // in the device's frame
};
enum class Decoded : std::uint8_t { reading, strange, other };
// `strange`: a reading that was not asked for, or has values that no device measures; `other`: no reading.
Decoded decode(Protocol protocol, const ReceivedMessage& message, Reading& reading) noexcept;

// Big-endian numbers in what was received; `at` + size must lie within.
inline std::uint16_t u16_at(Octets bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>((bytes[at] << 8U) | bytes[at + 1]);
}
inline std::uint32_t u32_at(Octets bytes, std::size_t at) noexcept {
  return (std::uint32_t{u16_at(bytes, at)} << 16U) | u16_at(bytes, at + 2);
}

}  // namespace kadans::imu

// Packets of Dynamixel protocol 2.0, from ROBOTIS' protocol manual:
//
//   FF FF FD 00 | id | length, 2 bytes | instruction | parameters | CRC, 2 bytes
//
// Numbers are little-endian. The length counts from the instruction on, CRC included. Where instruction and parameters
// would hold FF FF FD, which begins a packet, an FD is stuffed behind it; length and CRC are those of the stuffed
// packet. A status, which answers, has the instruction 55 and an error byte before its parameters.
//
// The answer to a fast sync read is one status that several servos write together, each its block: error, id, data, and
// a CRC over all bytes of the packet before it. It comes from the id FE and is not stuffed.
//
// Nothing from outside is used before its CRC was right. Buffers are fixed; nothing here allocates or throws.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "plant/serial/receive_buffer.h"

namespace kadans::dynamixel {

using Octets = std::span<const std::uint8_t>;

inline constexpr std::size_t packet_bytes_max = 1024;
inline constexpr std::uint8_t id_max = 252, broadcast_id = 0xFE;
// Of a packet without parameters, and of a status without data.
inline constexpr std::size_t packet_bytes_min = 10, status_bytes_min = 11;
// Of each block in the answer to a fast sync read, beside its data: error, id, CRC.
inline constexpr std::size_t fast_block_overhead = 4;

enum class Instruction : std::uint8_t {
  ping = 0x01,
  read = 0x02,
  write = 0x03,
  reboot = 0x08,
  status = 0x55,
  sync_read = 0x82,
  sync_write = 0x83,
  fast_sync_read = 0x8A
};

inline constexpr std::uint8_t alert_bit = 0x80;  // of the error byte: the servo has a hardware error
// Words for the number in the error byte; "" for 0.
std::string_view status_error_words(std::uint8_t error) noexcept;
// Words for the bits of the register Hardware Error Status: the gravest one.
std::string_view hardware_error_words(std::uint32_t bits) noexcept;

std::uint16_t crc16(Octets bytes, std::uint16_t crc = 0) noexcept;

// Builds a packet. When it would not fit, bytes() is empty.
class PacketWriter {
 public:
  PacketWriter(std::uint8_t id, Instruction instruction) noexcept;
  PacketWriter& u8(std::uint8_t value) noexcept;
  PacketWriter& u16(std::uint16_t value) noexcept;
  PacketWriter& u32(std::uint32_t value) noexcept;
  PacketWriter& number(std::uint32_t value, std::size_t bytes) noexcept;
  // Completes the packet. Nothing may be added after it.
  Octets finish() noexcept;

 private:
  std::array<std::uint8_t, packet_bytes_max> bytes_;
  std::size_t size_ = 0;
  unsigned run_ = 0;  // bytes of FF FF FD that the end already holds
  bool overflow_ = false;
};

struct ReceivedPacket {
  std::uint8_t id = 0, instruction = 0, error = 0;  // error: of a status
  Octets data;  // unstuffed; of a status behind its error byte; valid until the next call to the scanner
  Octets raw;   // the whole packet as it came
};

// Finds the packets in a stream of bytes that may be anything.
class PacketScanner : public ReceiveBuffer<2 * packet_bytes_max> {
 public:
  bool next(ReceivedPacket& packet) noexcept;  // false: no whole packet is here

 private:
  std::array<std::uint8_t, packet_bytes_max> plain_;
};

// The part of a fast sync read's answer that one servo wrote.
struct FastBlock {
  std::uint8_t error = 0;
  Octets data;
};
// Whether `packet` is the answer of exactly these servos in this order, `bytes` of data each, with every CRC right.
// Then block i of it is that of ids[i].
class FastAnswer {
 public:
  FastAnswer(const ReceivedPacket& packet, Octets ids, std::size_t bytes) noexcept;
  bool good() const noexcept { return good_; }
  FastBlock block(std::size_t index) const noexcept;

 private:
  Octets raw_;
  std::size_t bytes_;
  bool good_ = false;
};

// Little-endian numbers in what was received; `at` + size must lie within.
inline std::uint16_t u16_at(Octets bytes, std::size_t at) noexcept {
  return static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8U));
}
inline std::uint32_t u32_at(Octets bytes, std::size_t at) noexcept {
  return u16_at(bytes, at) | (std::uint32_t{u16_at(bytes, at + 2)} << 16U);
}

}  // namespace kadans::dynamixel

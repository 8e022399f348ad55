// One exchange after the other with the servos on a port, for what happens outside of the cycle: finding servos, asking
// them what they are, setting them up. Each call waits for the answer, for a bounded time; nothing allocates or throws.
//
// One owner, one thread at a time.
#pragma once

#include <optional>

#include "control_table.h"
#include "packet.h"
#include "plant/serial/serial_port.h"

namespace kadans::dynamixel {

enum class Answer : std::uint8_t { good, silence, garbage, refused };

class ServoBus {
 public:
  struct Identity {
    std::uint16_t model = 0;
    std::uint8_t firmware = 0;
  };

  // Keeps a reference. `patience_ns`: how long an answer may take beyond its time on the wire.
  ServoBus(SerialPort& port, std::uint32_t baud, std::int64_t patience_ns) noexcept
      : port_(port), baud_(baud), patience_ns_(patience_ns) {}

  // The servo's answer to one packet. The first says how it went, and error() with which number it refused.
  Answer ping(std::uint8_t id, Identity& identity) noexcept;
  Answer read(std::uint8_t id, Register from, std::uint32_t& value) noexcept;
  Answer write(std::uint8_t id, Register to, std::uint32_t value) noexcept;
  // Writes registers that lie side by side from `address` on.
  Answer write_bytes(std::uint8_t id, std::uint16_t address, Octets bytes) noexcept;
  Answer reboot(std::uint8_t id) noexcept;
  // To several servos, which do not answer.
  bool write_to_all(Register to, std::uint32_t value, Octets ids) noexcept;
  std::uint8_t error() const noexcept { return error_; }

 private:
  // `data`: how many bytes the answer carries.
  Answer exchange(PacketWriter& packet, std::uint8_t id, std::size_t data, ReceivedPacket& answer) noexcept;

  SerialPort& port_;
  std::uint32_t baud_;
  std::int64_t patience_ns_;
  std::uint8_t error_ = 0;
  PacketScanner scanner_;
};

}  // namespace kadans::dynamixel

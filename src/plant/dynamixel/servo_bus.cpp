#include "servo_bus.h"

namespace kadans::dynamixel {
namespace {

constexpr std::int64_t return_delay_max_ns = 508'000;  // 254 units: servos that nobody has set up yet

}  // namespace

Answer ServoBus::exchange(PacketWriter& packet, std::uint8_t id, std::size_t data, ReceivedPacket& answer) noexcept {
  const Octets bytes = packet.finish();
  scanner_.clear();
  port_.discard();
  error_ = 0;
  const std::uint64_t corrupt = scanner_.counts().corrupt, skipped = scanner_.counts().skipped;
  if (bytes.empty() || !port_.send(bytes)) return Answer::silence;
  const std::int64_t until_ns =
      port_.now_ns() + wire_ns(bytes.size() + status_bytes_min + data, baud_) + return_delay_max_ns + patience_ns_;
  std::size_t got = 0;
  for (;;) {
    while (scanner_.next(answer)) {
      const bool ours = answer.id == id && answer.instruction == static_cast<std::uint8_t>(Instruction::status);
      if (!ours) continue;  // our own bytes, on adapters that echo them
      error_ = answer.error & static_cast<std::uint8_t>(~alert_bit);
      if (error_ != 0) return Answer::refused;
      if (answer.data.size() == data) return Answer::good;
    }
    const std::size_t more = port_.receive(scanner_.room(), until_ns);
    if (more == 0) break;
    got += more;
    scanner_.filled(more);
  }
  const bool disturbed = scanner_.counts().corrupt > corrupt || scanner_.counts().skipped > skipped || got > 0;
  return disturbed ? Answer::garbage : Answer::silence;
}

Answer ServoBus::ping(std::uint8_t id, Identity& identity) noexcept {
  PacketWriter packet(id, Instruction::ping);
  ReceivedPacket answer;
  const Answer result = exchange(packet, id, 3, answer);
  if (result == Answer::good) identity = {.model = u16_at(answer.data, 0), .firmware = answer.data[2]};
  return result;
}

Answer ServoBus::read(std::uint8_t id, Register from, std::uint32_t& value) noexcept {
  PacketWriter packet(id, Instruction::read);
  packet.u16(from.address).u16(from.bytes);
  ReceivedPacket answer;
  const Answer result = exchange(packet, id, from.bytes, answer);
  if (result != Answer::good) return result;
  value = 0;
  for (std::size_t i = 0; i < from.bytes; ++i) value |= std::uint32_t{answer.data[i]} << (8 * i);
  return result;
}

Answer ServoBus::write(std::uint8_t id, Register to, std::uint32_t value) noexcept {
  PacketWriter packet(id, Instruction::write);
  packet.u16(to.address).number(value, to.bytes);
  ReceivedPacket answer;
  return exchange(packet, id, 0, answer);
}

Answer ServoBus::write_bytes(std::uint8_t id, std::uint16_t address, Octets bytes) noexcept {
  PacketWriter packet(id, Instruction::write);
  packet.u16(address);
  for (const std::uint8_t byte : bytes) packet.u8(byte);
  ReceivedPacket answer;
  return exchange(packet, id, 0, answer);
}

Answer ServoBus::reboot(std::uint8_t id) noexcept {
  PacketWriter packet(id, Instruction::reboot);
  ReceivedPacket answer;
  return exchange(packet, id, 0, answer);
}

bool ServoBus::write_to_all(Register to, std::uint32_t value, Octets ids) noexcept {
  PacketWriter packet(broadcast_id, Instruction::sync_write);
  packet.u16(to.address).u16(to.bytes);
  for (const std::uint8_t id : ids) packet.u8(id).number(value, to.bytes);
  const Octets bytes = packet.finish();
  return !bytes.empty() && port_.send(bytes);
}

}  // namespace kadans::dynamixel

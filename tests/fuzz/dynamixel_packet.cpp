// Bytes from a bus of servos: what the scanner takes for a packet has a right CRC, and a block of a fast sync read's
// answer is that of the servo that was asked.
//
// An input is bytes in pieces: length, bytes. A piece whose length is odd gets a right CRC at its end.
#include <algorithm>

#include "fuzz_input.h"
#include "plant/dynamixel/packet.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kadans;
  using namespace kadans::dynamixel;
  using fuzz::require;
  constexpr std::array<std::uint8_t, 2> ids{1, 2};
  fuzz::FuzzInput input(data, size);
  PacketScanner scanner;
  ReceivedPacket packet;
  while (!input.empty()) {
    const std::size_t length = input.byte();
    std::string piece(input.take(length));
    auto* const bytes = reinterpret_cast<std::uint8_t*>(piece.data());
    if (length % 2 == 1 && piece.size() > 2) {
      const std::uint16_t crc = crc16({bytes, piece.size() - 2});
      bytes[piece.size() - 2] = static_cast<std::uint8_t>(crc);
      bytes[piece.size() - 1] = static_cast<std::uint8_t>(crc >> 8U);
    }
    const std::span<std::uint8_t> room = scanner.room();
    require(room.size() >= 255, "a scanner has room for more");
    std::copy_n(bytes, piece.size(), room.begin());
    scanner.filled(piece.size());
    while (scanner.next(packet)) {
      require(packet.raw.size() >= packet_bytes_min && packet.raw.size() <= packet_bytes_max, "a packet has its size");
      require(crc16(packet.raw.first(packet.raw.size() - 2)) == u16_at(packet.raw, packet.raw.size() - 2),
              "a packet has its CRC");
      require(packet.data.size() < packet.raw.size(), "data are within the packet");
      const FastAnswer answer(packet, ids, 3);
      if (answer.good()) require(answer.block(1).data.size() == 3, "a block has its data");
      // What is sent again is read again.
      if (packet.id == broadcast_id || packet.instruction == static_cast<std::uint8_t>(Instruction::status)) continue;
      PacketWriter writer(packet.id, static_cast<Instruction>(packet.instruction));
      for (const std::uint8_t byte : packet.data) writer.u8(byte);
      const Octets again = writer.finish();
      if (again.empty()) continue;
      const std::string before(packet.data.begin(), packet.data.end());
      PacketScanner other;
      std::ranges::copy(again, other.room().begin());
      other.filled(again.size());
      require(other.next(packet) &&
                  std::ranges::equal(before, packet.data,
                                     [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }),
              "a packet is read as it was written");
    }
  }
  return 0;
}

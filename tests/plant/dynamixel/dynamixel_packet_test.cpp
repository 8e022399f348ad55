// The packets that ROBOTIS' manual shows, byte for byte, and bytes that are no packets.
#include <vector>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"
#include "plant/dynamixel/packet.h"

namespace kadans::dynamixel {
namespace {

using Packet = std::vector<std::uint8_t>;

Packet of(Octets bytes) { return {bytes.begin(), bytes.end()}; }

void put(PacketScanner& scanner, const Packet& bytes) {
  std::ranges::copy(bytes, scanner.room().begin());
  scanner.filled(bytes.size());
}

// As three servos answer a fast sync read of 2 bytes.
Packet fast_answer() {
  Packet bytes{0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x13, 0x00, 0x55};
  for (const std::uint8_t id : Packet{3, 7, 4}) {
    for (const std::uint8_t byte : {std::uint8_t{0}, id, std::uint8_t{0xFF}, std::uint8_t{0xFF}}) bytes.push_back(byte);
    const std::uint16_t crc = crc16(bytes);
    bytes.push_back(static_cast<std::uint8_t>(crc));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  }
  return bytes;
}

}  // namespace

TEST_CASE("Dynamixel packets are those of the manual") {
  CHECK(of(PacketWriter(1, Instruction::ping).finish()) ==
        Packet{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x01, 0x19, 0x4E});
  CHECK(of(PacketWriter(1, Instruction::read).u16(132).u16(4).finish()) ==
        Packet{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x02, 0x84, 0x00, 0x04, 0x00, 0x1D, 0x15});
  CHECK(of(PacketWriter(1, Instruction::write).u16(116).u32(512).finish()) ==
        Packet{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x09, 0x00, 0x03, 0x74, 0x00, 0x00, 0x02, 0x00, 0x00, 0xCA, 0x89});
  CHECK(of(PacketWriter(1, Instruction::reboot).finish()) ==
        Packet{0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x03, 0x00, 0x08, 0x2F, 0x4E});
  CHECK(of(PacketWriter(broadcast_id, Instruction::sync_read).u16(132).u16(4).u8(1).u8(2).finish()) ==
        Packet{0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x09, 0x00, 0x82, 0x84, 0x00, 0x04, 0x00, 0x01, 0x02, 0xCE, 0xFA});
  CHECK(
      of(PacketWriter(broadcast_id, Instruction::sync_write).u16(116).u16(4).u8(1).u32(150).u8(2).u32(170).finish()) ==
      Packet{0xFF, 0xFF, 0xFD, 0x00, 0xFE, 0x11, 0x00, 0x83, 0x74, 0x00, 0x04, 0x00,
             0x01, 0x96, 0x00, 0x00, 0x00, 0x02, 0xAA, 0x00, 0x00, 0x00, 0x82, 0x87});
}

TEST_CASE("The answers of Dynamixels in the manual are read") {
  PacketScanner scanner;
  put(scanner, {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x07, 0x00, 0x55, 0x00, 0x06, 0x04, 0x26, 0x65, 0x5D});
  put(scanner, {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x08, 0x00, 0x55, 0x00, 0xA6, 0x00, 0x00, 0x00, 0x8C, 0xC0});
  ReceivedPacket packet;
  REQUIRE(scanner.next(packet));
  CHECK(packet.id == 1);
  CHECK(packet.error == 0);
  CHECK(u16_at(packet.data, 0) == 1030);
  CHECK(packet.data[2] == 38);
  REQUIRE(scanner.next(packet));
  CHECK(u32_at(packet.data, 0) == 166);
  CHECK_FALSE(scanner.next(packet));
  CHECK(scanner.counts().packets == 2);
  CHECK(scanner.counts().skipped == 0);
}

TEST_CASE("A header within a packet is stuffed and unstuffed again") {
  PacketWriter writer(7, Instruction::write);
  for (const std::uint8_t byte : Packet{0xFF, 0xFF, 0xFD, 0x00, 0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 0xFF, 0xFF, 0xFD})
    writer.u8(byte);
  const Packet bytes = of(writer.finish());
  CHECK(bytes.size() == packet_bytes_min + 12 + 3);
  CHECK(Packet(bytes.begin() + 8, bytes.begin() + 13) == Packet{0xFF, 0xFF, 0xFD, 0xFD, 0x00});
  PacketScanner scanner;
  put(scanner, bytes);
  ReceivedPacket packet;
  REQUIRE(scanner.next(packet));
  CHECK(of(packet.data) == Packet{0xFF, 0xFF, 0xFD, 0x00, 0xFF, 0xFF, 0xFF, 0xFD, 0xFD, 0xFF, 0xFF, 0xFD});
}

TEST_CASE("A packet that is too long for a servo is none") {
  PacketWriter writer(broadcast_id, Instruction::sync_write);
  for (int i = 0; i < 2000; ++i) writer.u8(1);
  CHECK(writer.finish().empty());
}

TEST_CASE("Packets are found behind garbage, in pieces, and after lengths that lie") {
  const Packet good = of(PacketWriter(9, Instruction::ping).finish());
  PacketScanner scanner;
  ReceivedPacket packet;
  put(scanner, {0x12, 0xFF, 0xFF, 0xFD, 0x00, 0x01, 0xFF, 0xFF, 0x55});     // longer than any packet
  put(scanner, {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x00, 0x00, 0x55, 0x00});     // shorter than any
  put(scanner, {0xFF, 0xFF, 0xFD, 0x00, 0x01, 0x04, 0x00, 0x55, 0, 1, 2});  // a wrong CRC
  for (std::size_t i = 0; i < good.size(); ++i) {
    CHECK_FALSE(scanner.next(packet));
    put(scanner, {good[i]});
  }
  REQUIRE(scanner.next(packet));
  CHECK(packet.id == 9);
  CHECK(scanner.counts().corrupt == 3);
}

TEST_CASE("A fast sync read's answer counts whole, from the servos that were asked, or not at all") {
  const Packet good = fast_answer();
  const Packet ids{3, 7, 4};
  const auto read = [&](Packet bytes, const Packet& asked) {
    PacketScanner scanner;
    put(scanner, bytes);
    ReceivedPacket packet;
    return scanner.next(packet) && FastAnswer(packet, asked, 2).good();
  };
  CHECK(read(good, ids));
  CHECK_FALSE(read(good, {3, 4, 7}));
  CHECK_FALSE(read(good, {3, 7}));
  CHECK_FALSE(read(good, {}));
  for (std::size_t i = 0; i < 8 * good.size(); ++i) {
    Packet bent = good;
    bent[i / 8] ^= static_cast<std::uint8_t>(1U << (i % 8));
    CHECK_FALSE(read(bent, ids));
  }
  // The last CRC made right again: that of a block before it tells.
  Packet bent = good;
  bent[10] ^= 1;
  const std::uint16_t crc = crc16(Octets(bent).first(bent.size() - 2));
  bent[bent.size() - 2] = static_cast<std::uint8_t>(crc);
  bent[bent.size() - 1] = static_cast<std::uint8_t>(crc >> 8);
  CHECK_FALSE(read(bent, ids));
}

TEST_CASE("Of a million corrupted Dynamixel answers none is taken for another one") {
  const Packet good = fast_answer(), ids{3, 7, 4};
  RandomStream random(1, "bytes");
  PacketScanner scanner;
  ReceivedPacket packet;
  long taken = 0, wrong = 0;
  const testing::AllocationCount heap;
  for (int i = 0; i < 1'000'000; ++i) {
    scanner.clear();
    const std::span<std::uint8_t> room = scanner.room();
    std::ranges::copy(good, room.begin());
    const auto flips = 1 + random.next() % 8;
    for (std::uint64_t k = 0; k < flips; ++k)
      room[random.next() % good.size()] = static_cast<std::uint8_t>(random.next());
    const std::size_t size = random.next() % 4 == 0 ? random.next() % good.size() : good.size();
    const bool same = size == good.size() && std::equal(good.begin(), good.end(), room.begin());
    scanner.filled(size);
    while (scanner.next(packet)) {
      if (!FastAnswer(packet, ids, 2).good()) continue;
      ++taken;
      wrong += same ? 0 : 1;
    }
  }
  const long allocations = heap.count();
  CHECK(wrong == 0);
  CHECK(taken > 0);  // those that were hit where nothing changed
  CHECK(allocations == 0);
}

}  // namespace kadans::dynamixel

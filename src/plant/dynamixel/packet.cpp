#include "packet.h"

#include <algorithm>

namespace kadans::dynamixel {
namespace {

constexpr std::array<std::uint8_t, 4> header{0xFF, 0xFF, 0xFD, 0x00};
constexpr std::size_t length_at = 5, instruction_at = 7;
constexpr std::size_t length_min = 3;

constexpr std::array<std::uint16_t, 256> make_crc_table() {
  std::array<std::uint16_t, 256> table{};
  for (unsigned i = 0; i < 256; ++i) {
    unsigned crc = i << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = (crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x8005U : 0U);
    table[i] = static_cast<std::uint16_t>(crc);
  }
  return table;
}
constexpr std::array<std::uint16_t, 256> crc_table = make_crc_table();

// How many bytes of FF FF FD end with `byte`, when `run` of them stood before it.
unsigned run_after(unsigned run, std::uint8_t byte) noexcept {
  if (byte == 0xFF) return std::min(run + 1, 2U);
  return run == 2 && byte == 0xFD ? 3 : 0;
}

}  // namespace

std::string_view status_error_words(std::uint8_t error) noexcept {
  static constexpr std::array<std::string_view, 8> words{"",
                                                         "it could not carry the packet out",
                                                         "it does not know the instruction",
                                                         "it received a wrong CRC",
                                                         "a value is out of its range",
                                                         "the data are too short or too long",
                                                         "a value is beyond a limit that the servo is set to",
                                                         "the register is read-only, or locked while torque is on"};
  const auto number = static_cast<std::size_t>(error & ~alert_bit);
  return number < words.size() ? words[number] : std::string_view("an unknown error");
}

std::string_view hardware_error_words(std::uint32_t bits) noexcept {
  if ((bits & 0x04U) != 0) return "overheating";
  if ((bits & 0x10U) != 0) return "electrical shock or too little power";
  if ((bits & 0x08U) != 0) return "motor encoder fails";
  if ((bits & 0x20U) != 0) return "overload";
  if ((bits & 0x01U) != 0) return "input voltage out of range";
  return bits == 0 ? std::string_view() : std::string_view("unknown hardware error");
}

std::uint16_t crc16(Octets bytes, std::uint16_t crc) noexcept {
  for (const std::uint8_t byte : bytes)
    crc = static_cast<std::uint16_t>((crc << 8U) ^ crc_table[((crc >> 8U) ^ byte) & 0xFFU]);
  return crc;
}

PacketWriter::PacketWriter(std::uint8_t id, Instruction instruction) noexcept {
  std::ranges::copy(header, bytes_.begin());
  bytes_[header.size()] = id;
  size_ = instruction_at;
  u8(static_cast<std::uint8_t>(instruction));
}

PacketWriter& PacketWriter::u8(std::uint8_t value) noexcept {
  if (size_ + 4 > bytes_.size()) {  // room for the stuffing and the CRC
    overflow_ = true;
    return *this;
  }
  bytes_[size_++] = value;
  run_ = run_after(run_, value);
  if (run_ == 3) {
    bytes_[size_++] = 0xFD;
    run_ = 0;
  }
  return *this;
}

PacketWriter& PacketWriter::u16(std::uint16_t value) noexcept { return number(value, 2); }
PacketWriter& PacketWriter::u32(std::uint32_t value) noexcept { return number(value, 4); }

PacketWriter& PacketWriter::number(std::uint32_t value, std::size_t bytes) noexcept {
  for (std::size_t i = 0; i < bytes; ++i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
  return *this;
}

Octets PacketWriter::finish() noexcept {
  if (overflow_) return {};
  const std::size_t length = size_ + 2 - instruction_at;
  bytes_[length_at] = static_cast<std::uint8_t>(length);
  bytes_[length_at + 1] = static_cast<std::uint8_t>(length >> 8U);
  const std::uint16_t crc = crc16({bytes_.data(), size_});
  bytes_[size_++] = static_cast<std::uint8_t>(crc);
  bytes_[size_++] = static_cast<std::uint8_t>(crc >> 8U);
  return {bytes_.data(), size_};
}

bool PacketScanner::next(ReceivedPacket& packet) noexcept {
  for (;;) {
    const Octets bytes = here();
    const auto found = std::search(bytes.begin(), bytes.end(), header.begin(), header.end());
    if (found == bytes.end()) {  // the last bytes may begin a header
      const std::size_t keep = std::min(bytes.size(), header.size() - 1);
      skip(bytes.size() - keep);
      return false;
    }
    const auto before = static_cast<std::size_t>(found - bytes.begin());
    if (before > 0) {
      skip(before);
      continue;
    }
    if (bytes.size() < instruction_at) return false;
    const std::size_t length = u16_at(bytes, length_at), size = instruction_at + length;
    if (length < length_min || size > packet_bytes_max) {
      ++counts_.corrupt;
      skip(header.size());
      continue;
    }
    if (bytes.size() < size) return false;
    const Octets raw = bytes.first(size);
    if (crc16(raw.first(size - 2)) != u16_at(raw, size - 2)) {
      ++counts_.corrupt;
      skip(header.size());
      continue;
    }
    ++counts_.packets;
    drop(size);
    packet = {.id = raw[4], .instruction = raw[instruction_at], .raw = raw};
    std::size_t plain = 0;
    unsigned run = 0;
    const bool stuffed =
        packet.id != broadcast_id || packet.instruction != static_cast<std::uint8_t>(Instruction::status);
    for (std::size_t i = instruction_at; i < size - 2; ++i) {
      if (stuffed && run == 3) {  // what stands behind FF FF FD was stuffed
        run = 0;
        continue;
      }
      run = run_after(run, raw[i]);
      plain_[plain++] = raw[i];
    }
    const bool status = packet.instruction == static_cast<std::uint8_t>(Instruction::status);
    if (status && plain < 2) continue;  // no error byte
    if (status) packet.error = plain_[1];
    const std::size_t first = status ? 2 : 1;
    packet.data = Octets(plain_.data(), plain).subspan(first);
    return true;
  }
}

FastAnswer::FastAnswer(const ReceivedPacket& packet, Octets ids, std::size_t bytes) noexcept
    : raw_(packet.raw), bytes_(bytes) {
  const std::size_t stride = bytes + fast_block_overhead;
  if (ids.empty() || packet.id != broadcast_id ||
      packet.instruction != static_cast<std::uint8_t>(Instruction::status) ||
      raw_.size() != instruction_at + 1 + ids.size() * stride)
    return;
  std::uint16_t crc = crc16(raw_.first(instruction_at + 1));
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const Octets block = raw_.subspan(instruction_at + 1 + i * stride, stride);
    crc = crc16(block.first(stride - 2), crc);
    if (block[1] != ids[i] || u16_at(block, stride - 2) != crc) return;
    crc = crc16(block.last(2), crc);
  }
  good_ = true;
}

FastBlock FastAnswer::block(std::size_t index) const noexcept {
  const Octets block = raw_.subspan(instruction_at + 1 + index * (bytes_ + fast_block_overhead), bytes_ + 2);
  return {.error = block[0], .data = block.subspan(2)};
}

}  // namespace kadans::dynamixel

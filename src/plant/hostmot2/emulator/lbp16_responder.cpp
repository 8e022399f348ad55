#include "lbp16_responder.h"

#include <algorithm>
#include <cstring>

namespace kadans::hostmot2 {
namespace {

constexpr std::size_t reply_bytes_max = 1472;

unsigned word_at(std::span<const std::uint8_t> bytes, std::size_t at) { return bytes[at] + 256U * bytes[at + 1]; }

void put_word(std::span<std::uint8_t> bytes, std::size_t at, unsigned value) {
  bytes[at] = static_cast<std::uint8_t>(value);
  bytes[at + 1] = static_cast<std::uint8_t>(value >> 8U);
}

void count_up(std::span<std::uint8_t> words, std::size_t at) {
  put_word(words, at, std::min(0xFFFFU, word_at(words, at) + 1));
}

// Of the info areas: sizes, ranges and names of the memory spaces.
struct SpaceInfo {
  unsigned space, sizes, ranges;
  const char* name;
};
constexpr SpaceInfo spaces[] = {{0, 0x8104, 0x0010, "HostMot2"}, {1, 0x8202, 0x0008, "KSZ8851R"},
                                {2, 0x8E02, 0x0007, "EtherEEP"}, {3, 0x8F04, 0x8200, "FPGAFlsh"},
                                {4, 0x8202, 0x0004, "Timrs"},    {6, 0x8202, 0x0004, "LBP16RW"},
                                {7, 0x0202, 0x0004, "LBP16RO"}};

}  // namespace

Lbp16Responder::Lbp16Responder(EmulatedBoard& board) : board_(board) {
  constexpr std::array<std::uint8_t, 6> mac{0x01, 0x00, 0x12, 0x8B, 0x1A, 0x02};  // lowest byte first
  std::ranges::copy(mac, eeprom_.begin() + 2);
  const std::string& name = board.settings().name;
  std::copy_n(name.begin(), std::min<std::size_t>(16, name.size()), eeprom_.begin() + 0x10);
  std::copy_n(name.begin(), std::min<std::size_t>(16, name.size()), card_.begin());
  constexpr std::array<std::uint8_t, 4> ip{10, 10, 10, 10};
  std::ranges::copy(ip, eeprom_.begin() + 0x20);
  put_word(card_, 0x10, 3);
  put_word(card_, 0x12, 15);
  put_word(card_, 0x14, 1);
}

void Lbp16Responder::switch_power() noexcept {
  timers_ = {};
  status_ = {};
  pointers_ = {};
}

std::vector<std::uint8_t> Lbp16Responder::answer(std::span<const std::uint8_t> datagram) {
  ++datagrams_;
  count_up(status_, 0x08);
  count_up(status_, 0x0A);
  std::vector<std::uint8_t> reply;
  const Error error = carry_out(datagram, reply);
  put_word(status_, 0x1A, 0);  // the enable of EEPROM and flash holds for one datagram
  if (error != Error::none) {
    ++not_understood_;
    count_up(status_, 0x0C);
    status_[0] = static_cast<std::uint8_t>(status_[0] | static_cast<std::uint8_t>(error));
    count_up(status_, error == Error::parse ? 0x02 : error == Error::memory ? 0x04 : 0x06);
    return {};
  }
  if (!reply.empty()) count_up(status_, 0x10);
  return reply;
}

Lbp16Responder::Error Lbp16Responder::carry_out(std::span<const std::uint8_t> datagram,
                                                std::vector<std::uint8_t>& reply) {
  std::size_t at = 0;
  while (at < datagram.size()) {
    if (at + 2 > datagram.size()) return Error::parse;
    const unsigned word = word_at(datagram, at);
    at += 2;
    const Command command{.writes = (word & 0x8000U) != 0,
                          .info = (word & 0x2000U) != 0,
                          .space = word >> 10U & 7U,
                          .size = 1U << (word >> 8U & 3U),
                          .count = word & 0x7FU,
                          .increments = (word & 0x80U) != 0};
    if (command.count == 0) return Error::parse;
    if ((word & 0x4000U) != 0) {
      if (at + 2 > datagram.size()) return Error::parse;
      pointers_[command.space] = static_cast<std::uint16_t>(word_at(datagram, at));
      at += 2;
    }
    const std::size_t data = command.writes ? std::size_t{command.size} * command.count : 0;
    if (at + data > datagram.size()) return Error::parse;
    const Error error = one(command, datagram.subspan(at, data), reply);
    if (error != Error::none) return error;
    at += data;
  }
  return Error::none;
}

Lbp16Responder::Error Lbp16Responder::one(const Command& command, std::span<const std::uint8_t> data,
                                          std::vector<std::uint8_t>& reply) {
  if (command.info && (command.writes || command.size != 2)) return Error::parse;
  if (command.space == 5) return Error::memory;
  std::uint16_t& pointer = pointers_[command.space];
  for (unsigned i = 0; i < command.count; ++i) {
    const unsigned address = pointer;
    if (command.info) {
      for (unsigned k = 0; k < command.size; ++k) reply.push_back(info(command.space, address + k));
    } else if (command.writes) {
      std::uint64_t value = 0;
      for (unsigned k = 0; k < command.size; ++k)
        value |= std::uint64_t{data[std::size_t{i} * command.size + k]} << (8 * k);
      if (!write(command.space, address, command.size, value)) return Error::write;
    } else {
      std::uint64_t value = 0;
      if (!read(command.space, address, command.size, value)) return Error::memory;
      for (unsigned k = 0; k < command.size; ++k) reply.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    }
    if (command.increments) pointer = static_cast<std::uint16_t>(pointer + command.size);
    if (reply.size() > reply_bytes_max) return Error::memory;
  }
  return Error::none;
}

std::uint8_t Lbp16Responder::memory(unsigned space, unsigned address) const {
  const auto within = [&](std::span<const std::uint8_t> bytes) {
    return address < bytes.size() ? bytes[address] : std::uint8_t{0};
  };
  switch (space) {
    case 2:
      return within(eeprom_);
    case 3:
      return address == 8 ? 0x14 : 0;  // a chip of 16 Mbit
    case 4: {
      const auto microseconds = static_cast<std::uint16_t>(board_.time_ns() / 1000);
      return address < 2 ? static_cast<std::uint8_t>(microseconds >> (8 * address)) : within(timers_);
    }
    case 6:
      return within(status_);
    case 7:
      return within(card_);
    default:
      return 0;
  }
}

std::uint8_t Lbp16Responder::info(unsigned space, unsigned address) const {
  for (const SpaceInfo& is : spaces) {
    if (is.space != space) continue;
    const unsigned words[] = {0x5A00U | space, is.sizes, is.ranges, pointers_[space]};
    if (address < 8) return static_cast<std::uint8_t>(words[address / 2] >> (8 * (address % 2)));
    const std::size_t letter = address - 8;
    return letter < std::strlen(is.name) ? static_cast<std::uint8_t>(is.name[letter]) : std::uint8_t{0};
  }
  return 0;
}

bool Lbp16Responder::read(unsigned space, unsigned address, unsigned size, std::uint64_t& value) const {
  value = 0;
  if (space == 0) {
    if (size != 4) return false;
    std::uint32_t word = 0;
    if (!board_.read(address, word)) return false;
    value = word;
    return true;
  }
  for (unsigned k = 0; k < size; ++k) value |= std::uint64_t{memory(space, address + k)} << (8 * k);
  return true;
}

bool Lbp16Responder::write(unsigned space, unsigned address, unsigned size, std::uint64_t value) {
  if (space == 0) return size == 4 && board_.write(address, static_cast<std::uint32_t>(value));
  const auto put = [&](std::span<std::uint8_t> bytes, unsigned from) {
    if (address < from || address + size > bytes.size()) return false;
    for (unsigned k = 0; k < size; ++k) bytes[address + k] = static_cast<std::uint8_t>(value >> (8 * k));
    return true;
  };
  if (space == 4) return put(timers_, 2);
  if (space == 6) return put(status_, 0);
  if (space == 2) return word_at(status_, 0x1A) == 0x5A02 && put(eeprom_, 0x20);
  return false;  // flash and the card's own words stay as they are
}

}  // namespace kadans::hostmot2

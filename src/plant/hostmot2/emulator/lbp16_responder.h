// The Ethernet side of an emulated board: carries out the commands of a datagram, one after the other, and collects
// what they read. One that is wrong in any way ends it, and there is no reply at all.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "emulated_board.h"

namespace kadans::hostmot2 {

class Lbp16Responder {
 public:
  explicit Lbp16Responder(EmulatedBoard& board);

  // What the board sends back; empty: nothing.
  std::vector<std::uint8_t> answer(std::span<const std::uint8_t> datagram);
  void switch_power() noexcept;

  std::uint64_t datagrams() const noexcept { return datagrams_; }
  std::uint64_t not_understood() const noexcept { return not_understood_; }

 private:
  struct Command {
    bool writes, info;
    unsigned space, size, count;  // size: bytes of an element
    bool increments;
  };
  enum class Error : std::uint8_t { none = 0, parse = 1, memory = 2, write = 4 };

  Error carry_out(std::span<const std::uint8_t> datagram, std::vector<std::uint8_t>& reply);
  Error one(const Command& command, std::span<const std::uint8_t> data, std::vector<std::uint8_t>& reply);
  bool read(unsigned space, unsigned address, unsigned size, std::uint64_t& value) const;
  bool write(unsigned space, unsigned address, unsigned size, std::uint64_t value);
  std::uint8_t memory(unsigned space, unsigned address) const;
  std::uint8_t info(unsigned space, unsigned address) const;

  EmulatedBoard& board_;
  std::array<std::uint16_t, 8> pointers_{};
  std::array<std::uint8_t, 32> timers_{};  // space 4; its scratch words are from 0x10 on
  std::array<std::uint8_t, 32> status_{};  // space 6
  std::array<std::uint8_t, 48> eeprom_{};
  std::array<std::uint8_t, 32> card_{};
  std::uint64_t datagrams_ = 0, not_understood_ = 0;
};

}  // namespace kadans::hostmot2

// How the registers of a HostMot2 board are reached: by datagrams (lbp_link.h) or as memory (mapped_link.h). The
// modules' code is the same over both.
//
// A tick is laid out before the loop: which registers are read, which are written. send() lets the board first read,
// then write; collect() takes what it read. So a tick of the loop takes what the board read one tick before.
//
// One owner, one thread at a time. What is named of the tick neither allocates nor throws.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "plant/arrivals.h"

namespace kadans::hostmot2 {

// Registers of 32 bits that lie side by side, by the address of the first, in bytes.
struct RegisterBlock {
  std::uint16_t address = 0;
  std::uint16_t words = 0;
};

struct TickLayout {
  std::vector<RegisterBlock> reads;
  std::vector<RegisterBlock> writes;
  std::vector<RegisterBlock> rare_writes;  // behind the others, where a tick asks for them

  static std::size_t words(std::span<const RegisterBlock> blocks) noexcept {
    std::size_t sum = 0;
    for (const RegisterBlock& block : blocks) sum += block.words;
    return sum;
  }
};

struct RegisterWrite {
  std::uint16_t address = 0;
  std::uint32_t value = 0;
};

struct LinkCounts : DatagramCounts {
  std::uint32_t unheard = 0;  // of the lost ones: the board never had the request
  std::uint32_t short_ = 0;   // of the refused ones: replies that are not as long as was asked for
};

class BoardLink {
 public:
  virtual ~BoardLink() = default;
  BoardLink() = default;
  BoardLink(const BoardLink&) = delete;
  BoardLink& operator=(const BoardLink&) = delete;

  // Before the loop. Each waits for the answer, for a bounded time; false: there was none.
  virtual bool read(std::uint16_t address, std::span<std::uint32_t> into) = 0;
  virtual bool write(RegisterWrite one) = 0;
  // What on this machine is in the way of answers; "": nothing that it knows.
  virtual std::string why_silent() const { return ""; }
  virtual bool card_name(std::string& name) = 0;  // "": this way to the board has none
  // Before the loop. Throws std::length_error when it does not fit into a datagram.
  virtual void lay_out(const TickLayout& layout) = 0;

  // Of the tick. `words` in the order of the layout's writes, the rare ones only where they are asked for.
  virtual void send(std::span<const std::uint32_t> words) noexcept = 0;
  // False: nothing newer came. `time_ns`: when it was read, on this link's clock. `forgot`: the board does not know of
  // what was written before, as after its power was gone.
  struct Sample {
    std::int64_t time_ns = 0;
    std::uint32_t number = 0;  // of the tick that asked for it, counted from 1
    std::uint32_t heard = 0;   // of the newest tick whose writes the board had before
    bool forgot = false;
  };
  virtual bool collect(std::span<std::uint32_t> words, Sample& sample) noexcept = 0;
  // Writes these in one go, in this order, without an answer.
  virtual void write_all(std::span<const RegisterWrite> writes) noexcept = 0;

  virtual std::int64_t now_ns() const noexcept = 0;
  virtual const LinkCounts& counts() const noexcept = 0;
};

}  // namespace kadans::hostmot2

// Two sides take turns with memory that they share. One side writes the memory, then stores a number and rings a bell.
// The other side finds the number and then reads: all that was written before the number is complete. The memory now
// belongs to this side, until it gives a number of its own.
//
// Memory order: give() releases what its side wrote and has read, given() acquires it. The bell orders nothing: it only
// says that there is something to look at. A side that looks without the bell finds the same.
//
// Trivially copyable and without pointers, so it also works in memory that two processes share. A hostile process may
// write anything there at any time: a side that must not trust the other checks the number, and copies the data before
// it looks at them.
#pragma once

#include <cstdint>
#include <optional>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename Memory = MachineMemory>
class Turn {
 public:
  // The side that hands over. `Bell` is as Doorbell of realtime/machine/shared_memory.h.
  template <typename Bell>
  void give(std::uint32_t number, Bell& bell) noexcept {
    Memory::at(number_).store(number, std::memory_order_release);
    bell.ring();
  }

  // The other side: what was given last; 0: nothing yet. Wait-free.
  std::uint32_t given() const noexcept { return Memory::at(number_).load(std::memory_order_acquire); }

  // The other side: waits until a number other than `before` is given. Nothing: the side that gives is gone.
  template <typename Bell>
  std::optional<std::uint32_t> next(std::uint32_t before, Bell& bell) const noexcept {
    while (bell.wait(-1) != Bell::Heard::end) {
      if (const std::uint32_t number = given(); number != before) return number;
    }
    return std::nullopt;
  }

 private:
  typename Memory::template Word<std::uint32_t> number_{};
};
static_assert(std::is_trivially_copyable_v<Turn<>>);

}  // namespace kadans

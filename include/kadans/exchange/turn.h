// Two sides take turns over memory that they share: one writes, names a number last of all, and rings; the other finds
// that number, and then reads. What was written before is whole from then on, and belongs to the other side until it
// hands over a number of its own.
//
// Memory order: give() releases what its side wrote and has read, given() acquires it. The bell is no part of that: it
// says that there is something to look at, so who looks without having heard it finds the same.
//
// Trivially copyable, no pointers: also for memory that two processes share. The other side may write anything there at
// any time, if it is hostile: who must not trust it compares the number and copies before he looks.
#pragma once

#include <cstdint>
#include <optional>

#include "kadans/exchange/memory.h"

namespace kadans {

template <typename Memory = MachineMemory>
class Turn {
 public:
  // The side that hands over. `Bell` is as Doorbell of realtime/doorbell.h.
  template <typename Bell>
  void give(std::uint32_t number, Bell& bell) noexcept {
    Memory::at(number_).store(number, std::memory_order_release);
    bell.ring();
  }

  // The other side: what was given last; 0: nothing yet. Wait-free.
  std::uint32_t given() const noexcept { return Memory::at(number_).load(std::memory_order_acquire); }

  // The other side: waits until something else is given than `before`. Nothing: the side that gives is gone.
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

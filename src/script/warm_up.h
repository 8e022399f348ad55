// What a tick is going to need, read in one go before it. Every 10 ms something else has had the caches: what the tick
// touches comes from memory, and where it lies from page tables that come from memory too. The interpreter asks for it
// piece by piece, each only after the one before has come; asked for here, many are under way at once.
//
// Prefetch instructions would not do: processors drop them where the page table has to be walked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace kadans {

class WarmUp {
 public:
  // Before the loop. The memory must stay readable as long as go() is called; what finds no place is left out.
  void add(std::span<const std::byte> memory) noexcept;
  template <typename T>
  void add_object(const T& object) noexcept {
    add(std::as_bytes(std::span<const T, 1>(&object, 1)));
  }
  // The first instructions of a function.
  template <typename Result, typename... Arguments>
  void add_function(Result (*function)(Arguments...)) noexcept {
    add({reinterpret_cast<const std::byte*>(function), 2 * line_bytes});
  }
  // Whether others may have had the caches since the last call: not when ticks follow each other at once.
  bool due() noexcept { return due(cycles()); }
  bool due(std::uint64_t now_cycles) noexcept { return now_cycles - std::exchange(asked_, now_cycles) > hold_cycles; }
  void go() const noexcept;
  static void read(std::span<const std::byte> memory) noexcept;

 private:
  static constexpr std::size_t line_bytes = 64;
  static constexpr std::uint64_t hold_cycles = 1'000'000;  // some 0.3 ms
  static std::uint64_t cycles() noexcept;
  std::array<std::span<const std::byte>, 40> ranges_{};
  std::size_t count_ = 0;
  std::uint64_t asked_ = 0;
};

}  // namespace kadans

// Reads the memory that a tick will need in one go before the tick. Between two ticks, 10 ms apart, other work fills
// the caches. So a tick must fetch its data from memory, and also the page tables that locate the data. The interpreter
// would wait for one fetch after the other; here many fetches are under way at the same time.
//
// Prefetch instructions do not suffice: processors drop them when the page table must be walked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace kadans {

class WarmUp {
 public:
  // Before the loop. The memory must stay readable as long as go() is called. Ranges that find no place are left out.
  void add(std::span<const std::byte> memory) noexcept;
  template <typename T>
  void add_object(const T& object) noexcept {
    add(std::as_bytes(std::span<const T, 1>(&object, 1)));
  }
  // Adds the first instructions of a function.
  template <typename Result, typename... Arguments>
  void add_function(Result (*function)(Arguments...)) noexcept {
    add({reinterpret_cast<const std::byte*>(function), 2 * line_bytes});
  }
  // True when other work may have filled the caches since the last call; false when ticks follow each other at once.
  bool due() noexcept { return due(cycles()); }
  bool due(std::uint64_t now_cycles) noexcept { return now_cycles - std::exchange(asked_, now_cycles) > hold_cycles; }
  void go() const noexcept;
  static void read(std::span<const std::byte> memory) noexcept;

 private:
  static constexpr std::size_t line_bytes = 64;
  static constexpr std::uint64_t hold_cycles = 1'000'000;  // about 0.3 ms
  static std::uint64_t cycles() noexcept;
  std::array<std::span<const std::byte>, 40> ranges_{};
  std::size_t count_ = 0;
  std::uint64_t asked_ = 0;
};

}  // namespace kadans

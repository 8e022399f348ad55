// A running hash over the state of a run. Two runs that end with the same hash went through the same states, bit for
// bit; the value does not depend on the word size of the machine.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <span>
#include <string_view>

namespace kadans {

class StateHash {
 public:
  // Any integer: its value counts, not the width of its type.
  template <std::integral Integer>
  void add(Integer value) noexcept {
    hash_ ^= static_cast<std::uint64_t>(value);
    hash_ *= 0x9e3779b97f4a7c15U;  // 2^64 / golden ratio
    hash_ ^= hash_ >> 32;
  }
  // -0.0 and 0.0 are one state; every NaN is one state.
  void add(double value) noexcept {
    const std::uint64_t bits = value == 0.0 ? 0 : std::bit_cast<std::uint64_t>(value);
    add(value != value ? not_a_number : bits);
  }
  void add(std::span<const double> values) noexcept {
    for (const double value : values) add(value);
  }
  void add(std::string_view text) noexcept {
    add(text.size());
    for (const char letter : text) add(static_cast<unsigned char>(letter));
  }
  std::uint64_t value() const noexcept { return hash_; }

 private:
  static constexpr std::uint64_t not_a_number = 0x7ff8000000000000U;
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

}  // namespace kadans

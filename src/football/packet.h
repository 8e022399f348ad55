// Numbers in packets: little-endian, one behind the other. Nothing here allocates or throws.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

namespace kadans::football {

using Bytes = std::span<const std::byte>;

// What was read of a packet, or the sentence that says why it is refused.
template <typename T>
struct Checked {
  std::optional<T> value;
  std::string refusal;  // "" with a value
};

// Reads from a packet whose length was looked at before; behind its end there are zeros.
class PacketReader {
 public:
  explicit PacketReader(Bytes bytes) noexcept : bytes_(bytes) {}

  template <std::integral T>
  T take() noexcept {
    std::make_unsigned_t<T> number = 0;
    for (std::size_t i = 0; i < sizeof(T) && at_ < bytes_.size(); ++i, ++at_) {
      const auto octet = static_cast<std::uint64_t>(bytes_[at_]);
      number = static_cast<std::make_unsigned_t<T>>(number | (octet << (8 * i)));
    }
    return static_cast<T>(number);
  }
  float take_float() noexcept { return std::bit_cast<float>(take<std::uint32_t>()); }

 private:
  Bytes bytes_;
  std::size_t at_ = 0;
};

// Writes into a packet with room for all that is put.
class PacketWriter {
 public:
  explicit PacketWriter(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

  template <std::integral T>
  void put(T number) noexcept {
    const auto bits = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(number));
    for (std::size_t i = 0; i < sizeof(T) && at_ < bytes_.size(); ++i, ++at_)
      bytes_[at_] = static_cast<std::byte>((bits >> (8 * i)) & 0xFFU);
  }
  void put_float(float number) noexcept { put(std::bit_cast<std::uint32_t>(number)); }
  std::size_t size() const noexcept { return at_; }

 private:
  std::span<std::byte> bytes_;
  std::size_t at_ = 0;
};

}  // namespace kadans::football

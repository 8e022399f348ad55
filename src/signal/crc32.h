// CRC-32 as zlib and MCAP define it (polynomial 0x04c11db7 reflected, start and end inverted), over pieces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace kadans {

class Crc32 {
 public:
  void add(std::span<const std::byte> bytes) noexcept;
  std::uint32_t value() const noexcept { return ~state_; }

 private:
  std::uint32_t state_ = 0xffffffffU;
};

inline std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
  Crc32 crc;
  crc.add(bytes);
  return crc.value();
}

}  // namespace kadans

#include "signal/crc32.h"

#include <array>
#include <cstdint>
#include <string_view>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

TEST_CASE("Crc32 gives the check value of the CRC-32 of zlib") {
  CHECK(crc32(bytes_of("123456789")) == 0xcbf43926U);
  CHECK(crc32(bytes_of("")) == 0U);
  CHECK(crc32(bytes_of("The quick brown fox jumps over the lazy dog")) == 0x414fa339U);
}

TEST_CASE("Crc32 over pieces is that of the whole, wherever it is cut") {
  const std::string_view text = "sample, estimate, check, actuate, compute, publish";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Crc32 crc;
    crc.add(bytes_of(text.substr(0, cut)));
    crc.add(bytes_of(text.substr(cut)));
    REQUIRE(crc.value() == crc32(bytes_of(text)));
  }
}

TEST_CASE("Crc32 of many bytes at once is that of each by itself") {
  std::array<std::byte, 300> bytes{};
  std::uint32_t state = 1;
  for (std::byte& byte : bytes) byte = static_cast<std::byte>((state = state * 1664525U + 1013904223U) >> 24U);
  Crc32 singly;
  for (std::size_t count = 0; count < bytes.size(); ++count) {
    for (const std::size_t first : {std::size_t{0}, std::size_t{3}}) {
      if (first > count) continue;
      Crc32 crc;
      crc.add(std::span(bytes).first(first));
      crc.add(std::span(bytes).subspan(first, count - first));
      REQUIRE(crc.value() == singly.value());
    }
    singly.add(std::span(bytes).subspan(count, 1));
  }
}

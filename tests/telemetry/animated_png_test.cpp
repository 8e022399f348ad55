#include "telemetry/plot/animated_png.h"

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "signal/byte_order.h"
#include "signal/crc32.h"

using namespace kadans;

namespace {

const std::string head("\x89PNG\r\n\x1a\n", 8);

std::string number(std::uint32_t value) {
  std::string text;
  for (int shift = 24; shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xffU);
  return text;
}

std::string chunk(const std::string& kind, const std::string& data) {
  return number(static_cast<std::uint32_t>(data.size())) + kind + data + number(crc32(bytes_of(kind + data)));
}

std::string picture(std::uint32_t width, const std::string& data) {
  return head + chunk("IHDR", number(width) + number(2) + std::string("\x08\x02\0\0\0", 5)) + chunk("IDAT", data) +
         chunk("IEND", "");
}

}  // namespace

TEST_CASE("a film holds each picture's data under numbers that count, and shows each as long") {
  const std::string film = animated_png({picture(3, "first"), picture(3, "second")}, 20);
  const std::string size = number(3) + number(2) + number(0) + number(0);
  const std::string time("\x00\x01\x00\x14\x00\x00", 6);
  CHECK(film == head + chunk("IHDR", number(3) + number(2) + std::string("\x08\x02\0\0\0", 5)) +
                    chunk("acTL", number(2) + number(0)) + chunk("fcTL", number(0) + size + time) +
                    chunk("IDAT", "first") + chunk("fcTL", number(1) + size + time) +
                    chunk("fdAT", number(2) + "second") + chunk("IEND", ""));
}

TEST_CASE("a film of pictures that are damaged or of different sizes is refused") {
  CHECK_THROWS_AS(animated_png({}, 20), std::runtime_error);
  CHECK_THROWS_AS(animated_png({"no picture"}, 20), std::runtime_error);
  CHECK_THROWS_AS(animated_png({picture(3, "data").substr(0, 40)}, 20), std::runtime_error);
  CHECK_THROWS_AS(animated_png({picture(3, "a"), picture(4, "b")}, 20), std::runtime_error);
}

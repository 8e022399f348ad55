#include "animated_png.h"

#include <cstdint>
#include <stdexcept>
#include <string_view>

#include "signal/byte_order.h"
#include "signal/crc32.h"

namespace kadans {
namespace {

constexpr std::string_view signature("\x89PNG\r\n\x1a\n", 8);

std::string big_endian(std::uint32_t value, int bytes = 4) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xffU);
  return text;
}

std::uint32_t number_at(std::string_view text, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(text[at + i]);
  return value;
}

void put_chunk(std::string& to, std::string_view kind, std::string_view data) {
  const std::string body = std::string(kind) + std::string(data);
  to += big_endian(static_cast<std::uint32_t>(data.size())) + body + big_endian(crc32(bytes_of(body)));
}

struct Picture {
  std::string_view header;             // IHDR
  std::vector<std::string_view> data;  // IDAT
};

Picture read(std::string_view png) {
  Picture picture;
  if (!png.starts_with(signature)) throw std::runtime_error("a picture is no PNG");
  for (std::size_t at = signature.size(); at + 12 <= png.size();) {
    const std::size_t size = number_at(png, at);
    if (size > png.size() - at - 12) break;
    const std::string_view kind = png.substr(at + 4, 4), data = png.substr(at + 8, size);
    if (kind == "IHDR") picture.header = data;
    if (kind == "IDAT") picture.data.push_back(data);
    at += 12 + size;
  }
  if (picture.header.size() != 13 || picture.data.empty()) throw std::runtime_error("a picture is cut short");
  return picture;
}

}  // namespace

std::string animated_png(const std::vector<std::string>& pictures, int frames_per_s) {
  if (pictures.empty()) throw std::runtime_error("there are no pictures");
  const std::string_view header = read(pictures.front()).header;
  std::string film(signature);
  put_chunk(film, "IHDR", header);
  put_chunk(film, "acTL", big_endian(static_cast<std::uint32_t>(pictures.size())) + big_endian(0));  // for ever
  std::uint32_t number = 0;
  for (const std::string& png : pictures) {
    const Picture picture = read(png);
    if (picture.header != header) throw std::runtime_error("the pictures differ in size or kind");
    const std::string place = std::string(header.substr(0, 8)) + big_endian(0) + big_endian(0);
    const std::string time = big_endian(1, 2) + big_endian(static_cast<std::uint32_t>(frames_per_s), 2);
    put_chunk(film, "fcTL", big_endian(number++) + place + time + std::string(2, '\0'));
    for (const std::string_view data : picture.data) {
      if (&png == &pictures.front()) {
        put_chunk(film, "IDAT", data);
      } else {
        put_chunk(film, "fdAT", big_endian(number++) + std::string(data));
      }
    }
  }
  put_chunk(film, "IEND", "");
  return film;
}

}  // namespace kadans

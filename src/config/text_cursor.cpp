#include "text_cursor.h"

#include <cstdint>

namespace kadans {
namespace {

std::uint32_t byte(std::string_view text, std::size_t i) noexcept {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

// Length of the character at `i`, 0 when there is none.
std::size_t utf8_length(std::string_view text, std::size_t i) noexcept {
  const std::uint32_t first = byte(text, i);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U) return 0;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(text, i + k) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(text, i + k) & 0x3FU);
  }
  if (length == 3 && (code < 0x800U || (code >= 0xD800U && code <= 0xDFFFU))) return 0;
  if (length == 4 && (code < 0x10000U || code > 0x10FFFFU)) return 0;
  return length;
}

}  // namespace

std::size_t find_invalid_utf8(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return std::string_view::npos;
}

}  // namespace kadans

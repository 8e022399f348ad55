#include "utf8.h"

#include <cstdint>

namespace kadans {
namespace {

constexpr std::string_view replacement = "\xEF\xBF\xBD";
constexpr std::string_view no_characters[] = {"\xEF\xBF\xBE", "\xEF\xBF\xBF"};  // U+FFFE, U+FFFF

std::uint32_t byte(std::string_view text, std::size_t i) noexcept {
  return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U;
}

bool fits_xml(std::string_view character) noexcept {
  if (character.size() == 1)
    return byte(character, 0) >= 0x20U || character == "\n" || character == "\t" || character == "\r";
  return character != no_characters[0] && character != no_characters[1];
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) noexcept {
  const std::uint32_t first = byte(text, at);
  if (first < 0x80U) return 1;
  const std::size_t length = first >= 0xF0U ? 4 : first >= 0xE0U ? 3 : 2;
  if (first < 0xC2U || first > 0xF4U) return 0;
  std::uint32_t code = first & (0x7FU >> length);
  for (std::size_t k = 1; k < length; ++k) {
    if ((byte(text, at + k) & 0xC0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(text, at + k) & 0x3FU);
  }
  if (length == 3 && (code < 0x800U || (code >= 0xD800U && code <= 0xDFFFU))) return 0;
  if (length == 4 && (code < 0x10000U || code > 0x10FFFFU)) return 0;
  return length;
}

std::size_t find_invalid_utf8(std::string_view text) noexcept {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    if (length == 0) return i;
    i += length;
  }
  return std::string_view::npos;
}

void append_utf8(std::uint32_t code, std::string& text) {
  const auto tail = [&](std::uint32_t shift) { text += static_cast<char>(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80U) {
    text += static_cast<char>(code);
  } else if (code < 0x800U) {
    text += static_cast<char>(0xC0U | (code >> 6U));
    tail(0);
  } else if (code < 0x10000U) {
    text += static_cast<char>(0xE0U | (code >> 12U));
    tail(6);
    tail(0);
  } else {
    text += static_cast<char>(0xF0U | (code >> 18U));
    tail(12);
    tail(6);
    tail(0);
  }
}

std::size_t steering_length(std::string_view text, std::size_t at) noexcept {
  const std::uint32_t first = byte(text, at), second = byte(text, at + 1), third = byte(text, at + 2);
  if (first < 0x80U) return (first < 0x20U && first != '\n' && first != '\t') || first == 0x7FU ? 1 : 0;
  if (first == 0xC2U) return second >= 0x80U && second <= 0x9FU ? 2 : 0;  // U+0080..9F
  if (first == 0xD8U) return second == 0x9CU ? 2 : 0;                     // U+061C
  if (first != 0xE2U) return 0;
  const bool mark = second == 0x80U && (third == 0x8EU || third == 0x8FU);   // U+200E, U+200F
  const bool line = second == 0x80U && third >= 0xA8U && third <= 0xAEU;     // U+2028..202E
  const bool isolate = second == 0x81U && third >= 0xA6U && third <= 0xA9U;  // U+2066..2069
  return mark || line || isolate ? 3 : 0;
}

std::string shown_text(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i), steers = steering_length(text, i);
    if (length == 0 || steers > 0) {
      shown += '?';
    } else {
      shown += text.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return shown;
}

std::string xml_characters(std::string_view text) {
  std::string kept;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_length(text, i);
    const std::string_view character = length == 0 ? replacement : text.substr(i, length);
    if (fits_xml(character)) kept += character;
    i += length == 0 ? 1 : length;
  }
  return kept;
}

std::string html_text(std::string_view text) {
  std::string safe;
  for (const char c : xml_characters(text)) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string double_quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string csv_field(const std::string& text) {
  return text.find_first_of(",\"\r\n") == std::string::npos ? text : double_quoted(text);
}

}  // namespace kadans

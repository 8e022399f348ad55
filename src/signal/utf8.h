// Where the text of a file from outside goes: UTF-8, and the line and column of what stands in it.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace kadans {

// Text from outside, such as names of files and what scripts say, need not be UTF-8. Text that is written for others
// has to be.

// Number of bytes of the character at `at`; 0 when it is not valid (RFC 3629: shortest forms, no surrogates).
std::size_t utf8_length(std::string_view text, std::size_t at) noexcept;
// Where the text stops being UTF-8; npos when it is UTF-8 throughout.
std::size_t find_invalid_utf8(std::string_view text) noexcept;
// True for a continuation byte of UTF-8. Code that counts characters leaves these bytes out.
constexpr bool inside_character(char c) noexcept { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }
// Appends the character of this code, which must be a valid one.
void append_utf8(std::uint32_t code, std::string& text);
// Number of bytes of the character at `at` when a terminal obeys it instead of showing it; 0: it shows it. These are
// the control characters (C0, DEL, C1) but tab and line feed, and those that turn the direction of what stands around
// them.
std::size_t steering_length(std::string_view text, std::size_t at) noexcept;
// The text as a terminal may be given it: '?' in place of each character that it would obey and of each byte that is
// not UTF-8, for a terminal may take such a byte for a control character.
std::string shown_text(std::string_view text);
// The text with U+FFFD in place of each byte that is not UTF-8, and without the characters that XML cannot hold in any
// form: all control characters but tab and line ends.
std::string xml_characters(std::string_view text);
// The same, escaped for use between tags and in attributes.
std::string html_text(std::string_view text);
// In double quotes, each of those in it twice: as CSV and SQL have it.
std::string double_quoted(std::string_view text);
// In quotes where CSV needs them.
std::string csv_field(const std::string& text);

// Where something stands in a text from outside.
struct TextPlace {
  int line = 0;    // 1-based; 0: no place in the text
  int column = 0;  // 1-based, in characters
  auto operator<=>(const TextPlace&) const = default;

  // Where the text goes on behind this byte.
  constexpr void pass(char c) noexcept {
    if (c == '\n') {
      ++line, column = 1;
    } else if (!inside_character(c)) {
      ++column;
    }
  }
};

// Of a byte of the text.
constexpr TextPlace place_in(std::string_view text, std::size_t at) noexcept {
  TextPlace place{1, 1};
  for (const char c : text.substr(0, at)) place.pass(c);
  return place;
}

}  // namespace kadans

// Where something stands in a text from outside.
#pragma once

#include <compare>
#include <cstddef>
#include <string_view>

#include "utf8.h"

namespace kadans {

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

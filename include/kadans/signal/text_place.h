// Where something stands in a text from outside.
#pragma once

#include <compare>

namespace kadans {

struct TextPlace {
  int line = 0;    // 1-based; 0: no place in the text
  int column = 0;  // 1-based, in characters
  auto operator<=>(const TextPlace&) const = default;
};

}  // namespace kadans

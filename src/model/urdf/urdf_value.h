// The values that URDF's attributes can have, read strictly: a number takes up the whole text, is finite, and has a
// decimal point, not a comma.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace kadans {

enum class UrdfValue : std::uint8_t {
  text,             // anything
  name,             // not empty, at most 128 characters, no blanks around it
  number,           // finite, magnitude at most 1e9
  positive,         // > 0
  not_negative,     // >= 0
  vector,           // three numbers
  positive_vector,  // three numbers > 0
  scale,            // three numbers, none 0
  color,            // four numbers in 0..1
};

// What is wrong with the text as such a value ("is not a number, did you mean '2.5'?"). Nothing when it is right; then
// its numbers are in `numbers`, which has room for them or is null.
std::optional<std::string> read_value(UrdfValue kind, std::string_view text, double* numbers);

}  // namespace kadans

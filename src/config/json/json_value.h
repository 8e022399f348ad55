// A JSON text (RFC 8259) as a tree in which every value and every key knows its line and column.
//
// The parser is stricter than the standard: a key may stand only once in an object, values nest at most 64 deep, a text
// has at most 16 MB and a million values, numbers must fit a double, and the text must be UTF-8. It is looser in one
// point: it skips // and /* */ comments. Reading numbers does not depend on the locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "problems.h"
#include "signal/input_file.h"

namespace kadans {

struct JsonMember;

struct JsonValue {
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };
  Kind kind = Kind::null;
  TextPlace place;  // of its first character
  bool boolean = false;
  double number = 0;
  std::string text;                 // of a string; of a number the text as it was written
  std::vector<JsonValue> items;     // of an array
  std::vector<JsonMember> members;  // of an object, in the order of the file

  const JsonMember* find(std::string_view name) const noexcept;
};

struct JsonMember {
  std::string name;
  TextPlace place;  // of the key
  JsonValue value;
};

inline constexpr std::size_t json_depth_max = 64;
inline constexpr std::size_t json_values_max = 1'000'000;
inline constexpr std::size_t json_size_max_bytes = input_file_max_bytes;

// Throws InputError with the first mistake. `file` only names the text.
JsonValue parse_json(std::string_view text, const std::string& file);

}  // namespace kadans

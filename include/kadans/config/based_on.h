// A file that says only what is different from another one: "based_on" names that one, from the project root.
//
//   an object      has the base's keys, and those of the file in place of or after them
//   a list whose items all have a "name"    the same: items of the same name are merged, new ones come last
//   anything else  replaces what the base says
// A base may be based on another one, up to based_on_depth_max. What comes from a base is said to stand where the file
// names it; so a reader looks at the base first, for itself, that its own mistakes are told in their own place.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/config/json_value.h"

namespace kadans {

inline constexpr std::size_t based_on_depth_max = 8;

// A text, and what it is all based on, the nearest first.
struct BasedJson {
  JsonValue value;
  std::vector<std::filesystem::path> bases;
};

// Throws InputError with the first mistake: of JSON, a base that is not there, or files based on each other.
BasedJson parse_based_json(std::string_view text, const std::string& file);

// The file, and what it is based on. A file that cannot be read is based on nothing.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& file);

}  // namespace kadans

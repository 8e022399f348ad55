// Changes values in a JSON text. Everything else stays as it is: order, comments, blanks, other values.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json_value.h"

namespace kadans {

struct JsonEdit {
  // Keys from the root object on. "[NAME]" is the item of a list whose "name" is NAME: one that is not there is added.
  std::vector<std::string> path;
  std::string value;  // as JSON: 0.5, true, "a word"; of any kind but an object or a list
};

// A value that is there is replaced. One that is not becomes the last of the nearest object on its path that is there,
// on a line of its own where the one before it has one. `file` only names the text. Throws InputError when the text is
// no JSON, or when the path leads through a value that is no object or to one that is an object or a list.
std::string edit_json(std::string text, const std::string& file, const std::vector<JsonEdit>& edits);
// The value at such a path; nullptr where there is none.
const JsonValue* find_at(const JsonValue& root, const std::vector<std::string>& path);

// The parts of this, for other edits. Offsets are in bytes.
std::size_t offset_of(std::string_view text, TextPlace place);
std::size_t end_of_value(std::string_view text, const JsonValue& value);
// The blanks before a key that begins its line; nothing for one that stands behind others.
std::optional<std::string> own_indent(std::string_view text, std::size_t key);

}  // namespace kadans

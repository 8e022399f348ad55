#include "json_edit.h"

#include <algorithm>

namespace kadans {
namespace {

std::size_t end_of_string(std::string_view text, std::size_t at) {
  for (++at; text[at] != '"'; ++at) {
    if (text[at] == '\\') ++at;
  }
  return at + 1;
}

std::size_t end_of_comment(std::string_view text, std::size_t at) {
  return text[at + 1] == '/' ? text.find('\n', at) : text.find("*/", at) + 2;
}

bool is_scalar(const JsonValue& value) {
  return value.kind != JsonValue::Kind::object && value.kind != JsonValue::Kind::array;
}

// An object around what is still missing of the path.
std::string wrapped(std::vector<std::string>::const_iterator key, std::vector<std::string>::const_iterator end,
                    const std::string& value) {
  if (key == end) return value;
  return "{ \"" + *key + "\": " + wrapped(key + 1, end, value) + " }";
}

std::string entry_added(std::string text, const JsonValue& object, const std::string& entry) {
  if (object.members.empty()) return text.insert(offset_of(text, object.place) + 1, " " + entry + " ");
  const JsonMember& last = object.members.back();
  const std::size_t end = end_of_value(text, last.value);
  const auto indent = own_indent(text, offset_of(text, last.place));
  if (!indent) return text.insert(end, ", " + entry);
  // What is said behind the last one stays there.
  const std::size_t line_end = std::min(text.find('\n', end), text.size());
  const std::size_t said = text.find_first_not_of(" \t", end);
  const bool comment = said != std::string::npos && text.compare(said, 2, "//") == 0;
  text.insert(comment ? line_end : end, (comment ? "\n" : ",\n") + *indent + entry);
  return comment ? text.insert(end, ",") : text;
}

std::string value_set(std::string text, const std::string& file, const JsonEdit& edit) {
  const JsonValue json = parse_json(text, file);
  const JsonValue* here = &json;
  for (auto key = edit.path.begin(); key != edit.path.end(); ++key) {
    if (here->kind != JsonValue::Kind::object) refuse(file, here->place, "'" + *(key - 1) + "' must be an object");
    const JsonMember* const found = here->find(*key);
    if (found == nullptr) {
      const std::string value = wrapped(key + 1, edit.path.end(), edit.value);
      return entry_added(std::move(text), *here, "\"" + *key + "\": " + value);
    }
    here = &found->value;
  }
  if (!is_scalar(*here)) refuse(file, here->place, "'" + edit.path.back() + "' must be no object and no list");
  const std::size_t at = offset_of(text, here->place);
  return text.replace(at, end_of_value(text, *here) - at, edit.value);
}

}  // namespace

// Columns count characters, not bytes.
std::size_t offset_of(std::string_view text, TextPlace place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  for (int column = 1; column < place.column; ++column) {
    ++at;
    while (at < text.size() && inside_character(text[at])) ++at;
  }
  return at;
}

// The text has been parsed: what is opened is closed.
std::size_t end_of_value(std::string_view text, const JsonValue& value) {
  std::size_t at = offset_of(text, value.place);
  if (value.kind == JsonValue::Kind::string) return end_of_string(text, at);
  if (is_scalar(value)) return std::min(text.find_first_of(",]} \t\r\n/", at), text.size());
  int depth = 0;
  do {
    const char c = text[at];
    if (c == '"') {
      at = end_of_string(text, at);
      continue;
    }
    if (c == '/') {
      at = end_of_comment(text, at);
      continue;
    }
    if (c == '{' || c == '[') ++depth;
    if (c == '}' || c == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

std::optional<std::string> own_indent(std::string_view text, std::size_t key) {
  const std::size_t line = text.rfind('\n', key) + 1;
  if (text.find_first_not_of(" \t", line) != key) return std::nullopt;
  return std::string(text.substr(line, key - line));
}

std::string edit_json(std::string text, const std::string& file, const std::vector<JsonEdit>& edits) {
  for (const JsonEdit& edit : edits) text = value_set(std::move(text), file, edit);
  return text;
}

}  // namespace kadans

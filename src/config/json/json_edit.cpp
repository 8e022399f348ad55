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

// "[NAME]" as NAME; nothing for a key of an object.
std::optional<std::string_view> item_name(std::string_view key) {
  if (key.size() < 2 || key.front() != '[' || key.back() != ']') return std::nullopt;
  return key.substr(1, key.size() - 2);
}

// The value under the key of an object, or the item of a list.
const JsonValue* find_in(const JsonValue& here, std::string_view key) {
  if (const auto name = item_name(key)) {
    for (const JsonValue& item : here.items) {
      const JsonMember* const is = item.find("name");
      if (is != nullptr && is->value.kind == JsonValue::Kind::string && is->value.text == *name) return &item;
    }
    return nullptr;
  }
  const JsonMember* const found = here.find(key);
  return found == nullptr ? nullptr : &found->value;
}

// `inside` is an object that lacks its name.
std::string item_wrapped(std::string_view name, std::string inside) {
  return inside.insert(1, " \"name\": \"" + std::string(name) + "\",");
}

// An object or a list around what is still missing of the path.
std::string wrapped(std::vector<std::string>::const_iterator key, std::vector<std::string>::const_iterator end,
                    const std::string& value) {
  if (key == end) return value;
  if (const auto name = item_name(*key)) return "[" + item_wrapped(*name, wrapped(key + 1, end, value)) + "]";
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

std::string item_added(std::string text, const JsonValue& list, const std::string& item) {
  if (list.items.empty()) return text.insert(offset_of(text, list.place) + 1, item);
  return text.insert(end_of_value(text, list.items.back()), ", " + item);
}

std::string value_set(std::string text, const std::string& file, const JsonEdit& edit) {
  const JsonValue json = parse_json(text, file);
  const JsonValue* here = &json;
  for (auto key = edit.path.begin(); key != edit.path.end(); ++key) {
    const auto name = item_name(*key);
    if (here->kind != (name ? JsonValue::Kind::array : JsonValue::Kind::object))
      refuse(file, here->place, "'" + *(key - 1) + (name ? "' must be a list" : "' must be an object"));
    const JsonValue* const found = find_in(*here, *key);
    if (found == nullptr) {
      const std::string value = wrapped(key + 1, edit.path.end(), edit.value);
      if (name) return item_added(std::move(text), *here, item_wrapped(*name, value));
      return entry_added(std::move(text), *here, "\"" + *key + "\": " + value);
    }
    here = found;
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

const JsonValue* find_at(const JsonValue& root, const std::vector<std::string>& path) {
  const JsonValue* here = &root;
  for (const std::string& key : path) {
    if (here != nullptr) here = find_in(*here, key);
  }
  return here;
}

std::string edit_json(std::string text, const std::string& file, const std::vector<JsonEdit>& edits) {
  for (const JsonEdit& edit : edits) text = value_set(std::move(text), file, edit);
  return text;
}

}  // namespace kadans

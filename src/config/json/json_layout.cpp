#include "json_layout.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "foreign_json.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t line_max = 120;

using Kind = JsonValue::Kind;

std::string json_quoted(const std::string& text) { return json_text(nlohmann::ordered_json(text)); }

std::string on_one_line(const JsonValue& value) {
  std::string text;
  switch (value.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return value.boolean ? "true" : "false";
    case Kind::number:
      return value.text;
    case Kind::string:
      return json_quoted(value.text);
    case Kind::array:
      for (const JsonValue& item : value.items) text += (text.empty() ? "" : ", ") + on_one_line(item);
      return "[" + text + "]";
    case Kind::object:
      for (const JsonMember& member : value.members)
        text += (text.empty() ? " " : ", ") + json_quoted(member.name) + ": " + on_one_line(member.value);
      return text.empty() ? "{}" : "{" + text + " }";
  }
  return text;
}

bool has_lines(const JsonValue& value) {
  return value.kind == Kind::array && !value.items.empty() && value.items.front().kind == Kind::object;
}

// `before`: how many characters stand before it on its line.
std::string laid_out(const JsonValue& value, std::size_t indent, std::size_t before) {
  const bool whole = indent == 0 && value.kind == Kind::object;
  std::string line = on_one_line(value);
  const bool scalar = value.items.empty() && value.members.empty();
  if (scalar || (!whole && !has_lines(value) && before + line.size() < line_max)) return line;
  const bool object = value.kind == Kind::object;
  const std::string start = "\n" + std::string(indent + 2, ' ');
  std::string text;
  const auto add = [&](const std::string& key, const JsonValue& part) {
    const bool item_line = !object && part.kind == Kind::object;  // one line, however long
    text += (text.empty() ? "" : ",") + start + key +
            (item_line ? on_one_line(part) : laid_out(part, indent + 2, indent + 2 + key.size()));
  };
  for (const JsonValue& item : value.items) add("", item);
  for (const JsonMember& member : value.members) add(json_quoted(member.name) + ": ", member.value);
  return (object ? "{" : "[") + text + "\n" + std::string(indent, ' ') + (object ? "}" : "]");
}

}  // namespace

std::string laid_out(const JsonValue& value) { return laid_out(value, 0, 0) + "\n"; }

JsonValue json_string(std::string text) { return {.kind = Kind::string, .text = std::move(text)}; }

JsonValue json_number(double number) { return {.kind = Kind::number, .number = number, .text = number_text(number)}; }

JsonValue json_list(std::vector<JsonValue> items) { return {.kind = Kind::array, .items = std::move(items)}; }

JsonValue& member_of(JsonValue& object, const std::string& name) {
  const auto found = std::ranges::find(object.members, name, &JsonMember::name);
  if (found != object.members.end()) return found->value;
  return object.members.emplace_back(JsonMember{.name = name, .place = {}, .value = {}}).value;
}

void erase_member(JsonValue& object, std::string_view name) {
  std::erase_if(object.members, [&](const JsonMember& member) { return member.name == name; });
}

}  // namespace kadans

#include "event_text.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/problems.h"

namespace kadans {
namespace {

bool is_word_character(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

std::size_t size_of(const PlayArgument& field) noexcept {
  const auto* text = std::get_if<std::string>(&field.value);
  return field.name.size() + (text == nullptr ? sizeof(double) : text->size());
}

std::string out_of_bounds(const PlayArgument& field) {
  const std::string quoted = "field " + in_quotes(field.name);
  const bool named = !field.name.empty() && field.name.size() <= EventBounds::name_bytes &&
                     std::ranges::all_of(field.name, is_word_character);
  if (!named)
    return quoted + " must be named with letters, digits and '_', at most " + std::to_string(EventBounds::name_bytes);
  if (const auto* number = std::get_if<double>(&field.value); number != nullptr && !std::isfinite(*number))
    return quoted + " is not finite";
  const auto* text = std::get_if<std::string>(&field.value);
  if (text == nullptr) return "";
  if (text->size() > EventBounds::text_bytes)
    return quoted + " is longer than " + std::to_string(EventBounds::text_bytes) + " bytes";
  return find_invalid_utf8(*text) == std::string_view::npos ? "" : quoted + " is not UTF-8";
}

}  // namespace

bool is_event_name(std::string_view name) noexcept {
  if (name.empty() || name.size() > EventBounds::name_bytes) return false;
  char before = '.';
  for (const char c : name) {
    if (!is_word_character(c) && (c != '.' || before == '.')) return false;
    before = c;
  }
  return before != '.';
}

void check_event_name(const PlacedName& name, Problems& problems) {
  if (name.name.empty() || is_event_name(name.name)) return;
  problems.add(name.place, in_quotes(name.name) +
                               " is no name of an event: words of letters, digits and '_' with dots "
                               "between them, at most " +
                               std::to_string(EventBounds::name_bytes) + " characters");
}

std::string out_of_bounds(const std::vector<PlayArgument>& data) {
  if (data.size() > EventBounds::fields)
    return "an event's data has more than " + std::to_string(EventBounds::fields) + " fields";
  std::size_t bytes = 0;
  for (const PlayArgument& field : data) {
    if (std::string why = out_of_bounds(field); !why.empty()) return why;
    bytes += size_of(field);
  }
  return bytes <= EventBounds::data_bytes
             ? ""
             : "an event's data has more than " + std::to_string(EventBounds::data_bytes) + " bytes";
}

std::vector<PlayArgument> read_event_data(const JsonValue& object, Problems& problems) {
  using Kind = JsonValue::Kind;
  std::vector<PlayArgument> data;
  if (object.kind != Kind::object) problems.add(object.place, "an event's data is an object: { \"name\": value }");
  for (const JsonMember& member : object.members) {
    if (member.name == "doc") continue;  // a note for people
    const JsonValue& value = member.value;
    PlayArgument field{.name = member.name, .value = value.number, .place = value.place};
    if (value.kind == Kind::boolean) field.value = value.boolean;
    if (value.kind == Kind::string) field.value = value.text;
    if (value.kind != Kind::number && value.kind != Kind::boolean && value.kind != Kind::string) {
      problems.add(value.place, "field " + in_quotes(member.name) + " must be a number, true, false or a text");
    } else if (const std::string why = out_of_bounds(field); !why.empty()) {
      problems.add(value.place, why);
    }
    data.push_back(std::move(field));
    if (data.size() > EventBounds::fields) break;
  }
  if (const std::string why = out_of_bounds(data); problems.empty() && !why.empty()) problems.add(object.place, why);
  return data;
}

PlayedEvent read_event(std::string_view text, const std::string& source) {
  const auto refuse = [&](std::string why) { throw InputError({.file = source, .message = std::move(why)}); };
  const std::size_t end = std::min(text.find_first_of(" \t{"), text.size());
  PlayedEvent event{.name = std::string(text.substr(0, end))};
  if (!is_event_name(event.name))
    refuse(in_quotes(event.name) + " is no name of an event: words of letters, digits and '_' with dots between them");
  const std::size_t begin = text.find_first_not_of(" \t", end);
  if (begin == std::string_view::npos) return event;
  std::string_view data = text.substr(begin);
  data = data.substr(0, data.find_last_not_of(" \t") + 1);
  const std::size_t inside = data.front() == '{' ? data.find_first_not_of(" \t", 1) : 0;
  const bool json = data.front() == '{' && inside != std::string_view::npos && data[inside] == '"';
  if (json) {
    Problems problems(source);
    event.data = read_event_data(parse_json(data, source), problems);
    problems.throw_if_any();
  } else {
    const bool braces = data.size() >= 2 && data.front() == '{' && data.back() == '}';
    event.data = read_play_arguments(braces ? data.substr(1, data.size() - 2) : data, EventBounds::fields, source);
  }
  if (std::string why = out_of_bounds(event.data); !why.empty()) refuse(std::move(why));
  return event;
}

std::string data_json(const std::vector<PlayArgument>& data) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const PlayArgument& field : data) std::visit([&](const auto& value) { json[field.name] = value; }, field.value);
  return json_text(json);
}

std::string event_text(const PlayedEvent& event) {
  return event.name + (event.data.empty() ? "" : " " + data_json(event.data));
}

}  // namespace kadans

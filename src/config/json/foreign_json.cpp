#include "foreign_json.h"

#include <nlohmann/json.hpp>

#include "json_value.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// Where values nest deeper than json_depth_max; npos: nowhere. Of a text that is no JSON it says something or other.
std::size_t too_deep_at(std::string_view text) noexcept {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if ((c == '{' || c == '[') && ++depth > json_depth_max) return i;
    if ((c == '}' || c == ']') && depth > 0) --depth;
  }
  return std::string_view::npos;
}

[[noreturn]] void refuse_at(std::string_view text, std::size_t at, const std::string& file, const std::string& what) {
  const TextPlace place = place_in(text, at);
  if (!file.empty()) refuse(file, place, what);
  refuse(what + " (line " + std::to_string(place.line) + ", column " + std::to_string(place.column) + ")");
}

// "\u009b" of a character of one to three bytes.
std::string escaped(std::string_view character) {
  const auto bits = [&](std::size_t i, unsigned mask) { return static_cast<unsigned char>(character[i]) & mask; };
  unsigned code = bits(0, 0x7FU);
  if (character.size() == 2) code = (bits(0, 0x1FU) << 6U) | bits(1, 0x3FU);
  if (character.size() == 3) code = (bits(0, 0x0FU) << 12U) | (bits(1, 0x3FU) << 6U) | bits(2, 0x3FU);
  return printed("\\u%04x", code);
}

// Characters that a terminal would obey can stand in strings alone, so they can be written as "\u009b".
std::string without_steering(std::string text) {
  std::string safe;
  std::size_t copied = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto letter = static_cast<unsigned char>(text[i]);
    if (letter < 0x7FU) continue;
    const std::size_t length = steering_length(text, i);
    if (length == 0) continue;
    safe += std::string_view(text).substr(copied, i - copied);
    safe += escaped(std::string_view(text).substr(i, length));
    copied = i + length;
    i = copied - 1;
  }
  return copied == 0 ? std::move(text) : safe + text.substr(copied);
}

}  // namespace

std::optional<Json> read_foreign_json(std::string_view text) {
  if (too_deep_at(text) != std::string_view::npos) return std::nullopt;
  Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

Json parse_foreign_json(std::string_view text, const std::string& file) {
  if (const std::size_t at = too_deep_at(text); at != std::string_view::npos)
    refuse_at(text, at, file, "values are nested deeper than " + std::to_string(json_depth_max) + " levels");
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    refuse_at(text, error.byte > 0 ? error.byte - 1 : 0, file, "this is no JSON");
  } catch (const Json::exception&) {
    refuse(file, "this JSON holds a number beyond what a double can hold");
  }
}

std::string json_text(const Json& json, int indent) {
  return without_steering(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace kadans

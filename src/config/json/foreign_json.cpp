#include "foreign_json.h"

#include <nlohmann/json.hpp>

#include "json_value.h"

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
  throw InputError(
      {.message = what + " (line " + std::to_string(place.line) + ", column " + std::to_string(place.column) + ")"});
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
    throw InputError({.file = file, .message = "this JSON holds a number beyond what a double can hold"});
  }
}

std::string json_text(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kadans

// What the JSON reader and nlohmann-json, a parser that none of us wrote, make of one text.
#pragma once

#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "config/broken.h"
#include "config/json/json_value.h"

namespace kadans {

// Whether both trees say the same.
inline bool same(const JsonValue& ours, const nlohmann::json& theirs) {
  using Kind = JsonValue::Kind;
  switch (ours.kind) {
    case Kind::null:
      return theirs.is_null();
    case Kind::boolean:
      return theirs.is_boolean() && theirs.get<bool>() == ours.boolean;
    case Kind::number:
      return theirs.is_number() && theirs.get<double>() == ours.number;
    case Kind::string:
      return theirs.is_string() && theirs.get<std::string>() == ours.text;
    case Kind::array:
      break;
    case Kind::object:
      if (!theirs.is_object() || theirs.size() != ours.members.size()) return false;
      for (const JsonMember& member : ours.members) {
        if (!theirs.contains(member.name) || !same(member.value, theirs[member.name])) return false;
      }
      return true;
  }
  if (!theirs.is_array() || theirs.size() != ours.items.size()) return false;
  for (std::size_t i = 0; i < ours.items.size(); ++i) {
    if (!same(ours.items[i], theirs[i])) return false;
  }
  return true;
}

// "" when both agree about the text.
inline std::string disagreement(const std::string& text) {
  const nlohmann::json theirs = nlohmann::json::parse(text, nullptr, false, true);
  const std::string refused = refusal("t", "", [&] {
    const JsonValue ours = parse_json(text, "t");
    if (theirs.is_discarded() || !same(ours, theirs)) throw std::runtime_error("accepted: " + text);
  });
  // What is refused and is JSON for others must be what we are stricter about.
  bool stricter = false;
  for (const char* why : {"stands twice", "beyond what a double", "nested deeper", "is not UTF-8"})
    stricter = stricter || refused.find(why) != std::string::npos;
  return refused.empty() || theirs.is_discarded() || stricter ? "" : refused + " in " + text;
}

}  // namespace kadans

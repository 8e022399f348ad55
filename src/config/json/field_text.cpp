#include "field_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

bool is_plain(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '$';
  });
}

}  // namespace

std::string key_path(const std::string& path, std::string_view name) {
  if (!is_plain(name)) return path + "[" + in_quotes(name) + "]";
  return path.empty() ? std::string(name) : path + "." + std::string(name);
}

// What a value is, for a message.
std::string described(const JsonValue& value) {
  switch (value.kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return value.boolean ? "true" : "false";
    case Kind::number:
      return "the number " + value.text.substr(0, 40);
    case Kind::string:
      return "the string " + in_quotes(value.text);
    case Kind::array:
      return "an array";
    case Kind::object:
      return "an object";
  }
  return {};
}

std::string range_text(const std::string& min, const std::string& max, std::string_view unit) {
  const std::string behind = unit.empty() ? "" : " " + std::string(unit);
  if (!min.empty() && !max.empty()) return "must be " + min + ".." + max + behind;
  return (min.empty() ? "must be at most " + max : "must be at least " + min) + behind;
}

std::string range_text(const NumberRange& range) {
  const auto text = [](double limit) { return std::isfinite(limit) ? number_text(limit) : std::string(); };
  return range_text(text(range.min), text(range.max), range.unit);
}

std::string count_text(std::size_t found, CountRange count) {
  const bool bounded = count.max < std::numeric_limits<std::size_t>::max();
  return "has " + std::to_string(found) + (found == 1 ? " item, " : " items, ") +
         range_text(std::to_string(count.min), bounded ? std::to_string(count.max) : "", "");
}

std::string with_doc(std::string_view doc) { return doc.empty() ? std::string() : ": " + std::string(doc); }

FieldInfo info_of(FieldInfo::Kind kind, std::string_view name, std::string_view doc, Need need) {
  FieldInfo info;
  info.kind = kind;
  info.name = name;
  info.doc = doc;
  info.required = need == Need::required;
  return info;
}

FieldInfo number_info(std::string_view name, NumberRange range, std::string_view doc, Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::number, name, doc, need);
  info.unit = range.unit;
  info.min = range.min;
  info.max = range.max;
  return info;
}

std::string number_text(double value) {
  constexpr double plain_max = 1e9;  // up to here 1000000 reads better than 1e+06
  if (std::abs(value) < plain_max && value == std::floor(value)) return std::to_string(static_cast<long>(value));
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return error == std::errc{} ? std::string(buffer.data(), end) : std::string("?");
}

}  // namespace kadans

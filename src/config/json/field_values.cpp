// Fields that are values: numbers, strings, truths and arrays of them.
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "field_text.h"

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

// The whole number as written, without rounding up to 2^64; also from "2.0" and "1e3".
std::optional<std::uint64_t> whole(const JsonValue& value) {
  std::uint64_t result = 0;
  const char* const end = value.text.data() + value.text.size();
  const auto [stop, error] = std::from_chars(value.text.data(), end, result);
  if (error == std::errc{} && stop == end) return result;
  constexpr double exact_max = 9007199254740992.0;  // 2^53
  if (!(value.number >= 0 && value.number <= exact_max) || value.number != std::floor(value.number))
    return std::nullopt;
  return static_cast<std::uint64_t>(value.number);
}

}  // namespace

bool Fields::read_number(const JsonValue& value, const std::string& path, NumberRange range, std::string_view doc,
                         double& result) {
  if (value.kind != Kind::number) {
    wrong_type(value, path, range.unit.empty() ? "a number" : "a number in " + std::string(range.unit), doc);
    return false;
  }
  if (!(value.number >= range.min && value.number <= range.max)) {
    problems_->add(value.place, path + " is " + value.text.substr(0, 40) + ", " + range_text(range) + with_doc(doc));
    return false;
  }
  result = value.number;
  return true;
}

bool Fields::number(std::string_view name, double& value, NumberRange range, std::string_view doc, Need need) {
  FieldInfo info = number_info(name, range, doc, need);
  if (need == Need::optional && std::isfinite(value)) info.default_json = number_text(value);
  const JsonValue* given = take(std::move(info), need);
  return given != nullptr && read_number(*given, path(name), range, doc, value);
}

bool Fields::whole_number(std::string_view name, std::uint64_t& value, IntegerRange range, std::string_view doc,
                          Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::integer, name, doc, need);
  info.unit = range.unit;
  info.min = static_cast<double>(range.min);
  info.max = static_cast<double>(range.max);
  if (need == Need::optional) info.default_json = std::to_string(value);
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::number) {
    wrong_type(*given, path(name), "a whole number", doc);
    return false;
  }
  const std::optional<std::uint64_t> number = whole(*given);
  if (!number || *number < range.min || *number > range.max) {
    const std::string limits = range_text(std::to_string(range.min), std::to_string(range.max), range.unit);
    problems_->add(given->place, path(name) + " is " + given->text.substr(0, 40) + ", " + limits +
                                     (number || given->number < 0 ? "" : ", a whole number") + with_doc(doc));
    return false;
  }
  value = *number;
  return true;
}

bool Fields::boolean(std::string_view name, bool& value, std::string_view doc, Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::boolean, name, doc, need);
  if (need == Need::optional) info.default_json = value ? "true" : "false";
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::boolean) {
    wrong_type(*given, path(name), "true or false", doc);
    return false;
  }
  value = given->boolean;
  return true;
}

bool Fields::string(std::string_view name, std::string& value, std::string_view doc, Need need) {
  const JsonValue* given = take(info_of(FieldInfo::Kind::string, name, doc, need), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::string) {
    wrong_type(*given, path(name), "a string", doc);
    return false;
  }
  if (given->text.empty() && need == Need::required) {
    problems_->add(given->place, path(name) + " must not be empty" + with_doc(doc));
    return false;
  }
  value = given->text;
  return true;
}

bool Fields::one_of(std::string_view name, std::size_t& index, std::span<const std::string> names, std::string_view doc,
                    Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::string, name, doc, need);
  info.choices.assign(names.begin(), names.end());
  if (need == Need::optional && index < names.size()) info.default_json = "\"" + names[index] + "\"";
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::string) {
    wrong_type(*given, path(name), "a string", doc);
    return false;
  }
  const auto found = std::find(names.begin(), names.end(), given->text);
  if (found == names.end()) {
    problems_->add(given->place, path(name) + ": " + unknown_name("value", given->text, names));
    return false;
  }
  index = static_cast<std::size_t>(found - names.begin());
  return true;
}

bool Fields::strings(std::string_view name, std::vector<PlacedName>& values, CountRange count, std::string_view doc,
                     Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::list, name, doc, need);
  info.count = count;
  info.fields.push_back(info_of(FieldInfo::Kind::string, "", "", Need::optional));
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::array) {
    wrong_type(*given, path(name), "an array of strings", doc);
    return false;
  }
  if (!(given->items.size() >= count.min && given->items.size() <= count.max)) {
    problems_->add(given->place, path(name) + " " + count_text(given->items.size(), count) + with_doc(doc));
    return false;
  }
  std::vector<PlacedName> read;
  for (const JsonValue& item : given->items) {
    if (item.kind == Kind::string) {
      read.push_back({item.text, item.place});
    } else {
      wrong_type(item, path(name) + "[" + std::to_string(&item - given->items.data()) + "]", "a string", doc);
    }
  }
  if (read.size() != given->items.size()) return false;
  values = std::move(read);
  return true;
}

bool Fields::numbers(std::string_view name, std::span<double> values, NumberRange range, std::string_view doc,
                     Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::list, name, doc, need);
  info.count = {values.size(), values.size()};
  info.fields.push_back(number_info("", range, "", Need::optional));
  if (need == Need::optional) {
    for (const double value : values)
      info.default_json += (info.default_json.empty() ? "[" : ", ") + number_text(value);
    info.default_json += "]";
  }
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  const std::string wanted = "an array of " + std::to_string(values.size()) + " numbers" +
                             (range.unit.empty() ? "" : " in " + std::string(range.unit));
  if (given->kind != Kind::array) {
    wrong_type(*given, path(name), wanted, doc);
    return false;
  }
  if (given->items.size() != values.size()) {
    problems_->add(given->place, path(name) + " must be " + wanted + ", it has " + std::to_string(given->items.size()) +
                                     with_doc(doc));
    return false;
  }
  bool all = true;
  for (std::size_t i = 0; i < values.size(); ++i) {
    all = read_number(given->items[i], path(name) + "[" + std::to_string(i) + "]", range, doc, values[i]) && all;
  }
  return all;
}

bool Fields::number_list(std::string_view name, std::vector<double>& values, CountRange count, NumberRange range,
                         std::string_view doc, Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::list, name, doc, need);
  info.count = count;
  info.fields.push_back(number_info("", range, "", Need::optional));
  const JsonValue* given = take(std::move(info), need);
  if (given == nullptr) return false;
  if (given->kind != Kind::array) {
    wrong_type(*given, path(name), "an array of numbers", doc);
    return false;
  }
  if (!(given->items.size() >= count.min && given->items.size() <= count.max)) {
    problems_->add(given->place, path(name) + " " + count_text(given->items.size(), count) + with_doc(doc));
    return false;
  }
  std::vector<double> read(given->items.size());
  bool all = true;
  for (std::size_t i = 0; i < read.size(); ++i) {
    all = read_number(given->items[i], path(name) + "[" + std::to_string(i) + "]", range, doc, read[i]) && all;
  }
  if (all) values = std::move(read);
  return all;
}

}  // namespace kadans

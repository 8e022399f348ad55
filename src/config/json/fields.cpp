#include "fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace kadans {
namespace {

using Kind = JsonValue::Kind;

// The texts of messages about fields, and the descriptions of fields.

bool is_plain(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '$';
  });
}

// "plant.drives" and "*_knee" -> plant.drives['*_knee']
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

// "must be 0..1 rad", "must be at least 0 Nm". An empty string means no limit.
std::string range_text(const std::string& min, const std::string& max, std::string_view unit) {
  const std::string behind = unit.empty() ? "" : " " + std::string(unit);
  if (!min.empty() && !max.empty()) return "must be " + min + ".." + max + behind;
  return (min.empty() ? "must be at most " + max : "must be at least " + min) + behind;
}

std::string range_text(const NumberRange& range) {
  const auto text = [](double limit) { return std::isfinite(limit) ? number_text(limit) : std::string(); };
  return range_text(text(range.min), text(range.max), range.unit);
}

// "has 5 items, must be 0..4"
std::string count_text(std::size_t found, CountRange count) {
  const bool bounded = count.max < std::numeric_limits<std::size_t>::max();
  return "has " + std::to_string(found) + (found == 1 ? " item, " : " items, ") +
         range_text(std::to_string(count.min), bounded ? std::to_string(count.max) : "", "");
}

// ": what the field means"
std::string with_doc(std::string_view doc) { return doc.empty() ? std::string() : ": " + std::string(doc); }

FieldInfo info_of(FieldInfo::Kind kind, std::string_view name, std::string_view doc, Need need) {
  FieldInfo info;
  info.kind = kind;
  info.name = name;
  info.doc = doc;
  info.required = need == Need::required;
  return info;
}

FieldInfo list_info(std::string_view name, std::string_view doc, Need need, CountRange count, FieldInfo item) {
  FieldInfo info = info_of(FieldInfo::Kind::list, name, doc, need);
  info.count = count;
  info.fields.push_back(std::move(item));
  return info;
}

FieldInfo number_info(std::string_view name, NumberRange range, std::string_view doc, Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::number, name, doc, need);
  info.unit = range.unit;
  info.min = range.min;
  info.max = range.max;
  return info;
}

// "a number in rad"
std::string in_unit(const std::string& what, const NumberRange& range) {
  return range.unit.empty() ? what : what + " in " + std::string(range.unit);
}

constexpr std::string_view doc_key = "doc";

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

std::string Fields::path(std::string_view name) const { return key_path(path_, name); }

TextPlace Fields::place(std::string_view name) const {
  const JsonMember* member = value_ == nullptr ? nullptr : value_->find(name);
  return member == nullptr ? place() : member->value.place;
}

// The value of a field, or null: not given or not of this kind, or there is no file and the field is only described.
const JsonValue* Fields::take(FieldInfo info, Kind kind, const std::string& wanted) {
  known_.push_back(info.name);
  if (value_ == nullptr) {
    described_->fields.push_back(std::move(info));
    return nullptr;
  }
  const JsonMember* member = value_->find(info.name);
  if (member != nullptr) return is(kind, member->value, path(info.name), wanted, info.doc) ? &member->value : nullptr;
  if (info.required) {
    problems_->add(value_->place,
                   "key '" + info.name + "' is missing" + (path_.empty() ? "" : " in " + path_) + with_doc(info.doc));
  }
  return nullptr;
}

bool Fields::is(Kind kind, const JsonValue& value, const std::string& path, const std::string& wanted,
                std::string_view doc) const {
  if (value.kind == kind) return true;
  refuse(value.place, path + " must be " + wanted + ", not " + described(value) + with_doc(doc));
  return false;
}

bool Fields::is_counted(const JsonValue& list, const std::string& path, CountRange count, std::string_view doc) const {
  if (list.items.size() >= count.min && list.items.size() <= count.max) return true;
  refuse(list.place, path + " " + count_text(list.items.size(), count) + with_doc(doc));
  return false;
}

// True when there is no file: the members of this object, whose keys are free, are described.
bool Fields::describe_entries(FieldInfo each) {
  any_key_ = true;
  if (value_ != nullptr) return false;
  described_->kind = FieldInfo::Kind::map;
  described_->fields.assign(1, std::move(each));
  return true;
}

void Fields::number_entries(std::vector<NumberEntry>& entries, NumberRange range, std::string_view doc) {
  if (describe_entries(number_info("", range, doc, Need::optional))) return;
  for (const JsonMember& member : value_->members) {
    if (member.name == doc_key) continue;
    NumberEntry entry{member.name, 0, member.place, member.value.place};
    if (read_number(member.value, path(member.name), range, doc, entry.value)) entries.push_back(std::move(entry));
  }
}

const JsonValue* Fields::plain_entries(std::string_view doc) {
  return describe_entries(info_of(FieldInfo::Kind::plain, "", doc, Need::optional)) ? nullptr : value_;
}

void Fields::text_entries(std::vector<TextEntry>& entries, std::string_view doc) {
  if (describe_entries(info_of(FieldInfo::Kind::string, "", doc, Need::optional))) return;
  for (const JsonMember& member : value_->members) {
    if (member.name == doc_key || !is(Kind::string, member.value, path(member.name), "a string", doc)) continue;
    entries.push_back({member.name, member.value.text, member.place, member.value.place});
  }
}

Fields Fields::open_child(const JsonValue& value, std::string path) const {
  Fields child(value, *problems_);
  child.path_ = std::move(path);
  return child;
}

std::vector<Fields> Fields::open(FieldInfo::Kind kind, std::string_view name, std::string_view doc, CountRange count,
                                 Need need) {
  FieldInfo info = info_of(kind, name, doc, need);
  info.count = count;
  if (kind != FieldInfo::Kind::object) info.fields.emplace_back();
  const bool list = kind == FieldInfo::Kind::list;
  const JsonValue* given =
      take(std::move(info), list ? Kind::array : Kind::object, list ? "an array of objects" : "an object");
  std::vector<Fields> children;
  if (value_ == nullptr) {
    FieldInfo& field = described_->fields.back();
    children.emplace_back(kind == FieldInfo::Kind::object ? field : field.fields.back(), *problems_);
    return children;
  }
  if (given == nullptr) return children;
  if (kind == FieldInfo::Kind::object) children.push_back(open_child(*given, path(name)));
  open_items(kind, *given, path(name), count, doc, children);
  return children;
}

// The objects in an array or in a map.
void Fields::open_items(FieldInfo::Kind kind, const JsonValue& given, const std::string& path, CountRange count,
                        std::string_view doc, std::vector<Fields>& children) {
  const auto open_item = [&](const JsonValue& item, const std::string& item_path) {
    if (!is(Kind::object, item, item_path, "an object", doc)) return false;
    children.push_back(open_child(item, item_path));
    return true;
  };
  if (kind == FieldInfo::Kind::list) {
    if (!is_counted(given, path, count, doc)) return;
    for (std::size_t i = 0; i < given.items.size(); ++i) {
      open_item(given.items[i], path + "[" + std::to_string(i) + "]");
    }
  } else if (kind == FieldInfo::Kind::map) {
    for (const JsonMember& member : given.members) {
      if (member.name == doc_key || !open_item(member.value, key_path(path, member.name))) continue;
      children.back().key_ = member.name;
      children.back().key_place_ = member.place;
    }
  }
}

void Fields::finish() {
  if (value_ == nullptr) return;
  for (const JsonMember& member : value_->members) {
    const bool known = any_key_ || std::find(known_.begin(), known_.end(), member.name) != known_.end();
    if (member.name == doc_key) {
      is(Kind::string, member.value, path(doc_key), "a string", "a note for people");
    } else if (!known) {
      problems_->add_unknown(member.place, "key", member.name, known_, path_.empty() ? "" : "in " + path_);
    }
  }
}

bool Fields::read_number(const JsonValue& value, const std::string& path, NumberRange range, std::string_view doc,
                         double& result) {
  if (!is(Kind::number, value, path, in_unit("a number", range), doc)) return false;
  if (!(value.number >= range.min && value.number <= range.max)) {
    problems_->add(value.place, path + " is " + value.text.substr(0, 40) + ", " + range_text(range) + with_doc(doc));
    return false;
  }
  result = value.number;
  return true;
}

bool Fields::read_numbers(const JsonValue& list, const std::string& path, NumberRange range, std::string_view doc,
                          std::span<double> results) {
  bool all = true;
  for (std::size_t i = 0; i < results.size(); ++i) {
    all = read_number(list.items[i], path + "[" + std::to_string(i) + "]", range, doc, results[i]) && all;
  }
  return all;
}

bool Fields::number(std::string_view name, double& value, NumberRange range, std::string_view doc, Need need) {
  FieldInfo info = number_info(name, range, doc, need);
  if (need == Need::optional && std::isfinite(value)) info.default_json = number_text(value);
  const JsonValue* given = take(std::move(info), Kind::number, in_unit("a number", range));
  return given != nullptr && read_number(*given, path(name), range, doc, value);
}

bool Fields::whole_number(std::string_view name, std::uint64_t& value, IntegerRange range, std::string_view doc,
                          Need need) {
  FieldInfo info = info_of(FieldInfo::Kind::integer, name, doc, need);
  info.unit = range.unit;
  info.min = static_cast<double>(range.min);
  info.max = static_cast<double>(range.max);
  if (need == Need::optional) info.default_json = std::to_string(value);
  const JsonValue* given = take(std::move(info), Kind::number, "a whole number");
  if (given == nullptr) return false;
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
  const JsonValue* given = take(std::move(info), Kind::boolean, "true or false");
  if (given == nullptr) return false;
  value = given->boolean;
  return true;
}

bool Fields::string(std::string_view name, std::string& value, std::string_view doc, Need need) {
  const JsonValue* given = take(info_of(FieldInfo::Kind::string, name, doc, need), Kind::string, "a string");
  if (given == nullptr) return false;
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
  const JsonValue* given = take(std::move(info), Kind::string, "a string");
  if (given == nullptr) return false;
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
  const JsonValue* given =
      take(list_info(name, doc, need, count, info_of(FieldInfo::Kind::string, "", "", Need::optional)), Kind::array,
           "an array of strings");
  if (given == nullptr || !is_counted(*given, path(name), count, doc)) return false;
  std::vector<PlacedName> read;
  for (const JsonValue& item : given->items) {
    const std::string item_path = path(name) + "[" + std::to_string(&item - given->items.data()) + "]";
    if (is(Kind::string, item, item_path, "a string", doc)) read.push_back({item.text, item.place});
  }
  if (read.size() != given->items.size()) return false;
  values = std::move(read);
  return true;
}

bool Fields::numbers(std::string_view name, std::span<double> values, NumberRange range, std::string_view doc,
                     Need need) {
  FieldInfo info =
      list_info(name, doc, need, {values.size(), values.size()}, number_info("", range, "", Need::optional));
  if (need == Need::optional) {
    for (const double value : values)
      info.default_json += (info.default_json.empty() ? "[" : ", ") + number_text(value);
    info.default_json += "]";
  }
  const std::string wanted = in_unit("an array of " + std::to_string(values.size()) + " numbers", range);
  const JsonValue* given = take(std::move(info), Kind::array, wanted);
  if (given == nullptr) return false;
  if (given->items.size() != values.size()) {
    problems_->add(given->place, path(name) + " must be " + wanted + ", it has " + std::to_string(given->items.size()) +
                                     with_doc(doc));
    return false;
  }
  return read_numbers(*given, path(name), range, doc, values);
}

bool Fields::number_list(std::string_view name, std::vector<double>& values, CountRange count, NumberRange range,
                         std::string_view doc, Need need) {
  const JsonValue* given = take(list_info(name, doc, need, count, number_info("", range, "", Need::optional)),
                                Kind::array, "an array of numbers");
  if (given == nullptr || !is_counted(*given, path(name), count, doc)) return false;
  std::vector<double> read(given->items.size());
  if (!read_numbers(*given, path(name), range, doc, read)) return false;
  values = std::move(read);
  return true;
}

}  // namespace kadans

// A function that reads an object is a list of its fields. The list is both the reader and the schema.
//
//   void engine_fields(Fields& f, EngineSettings& engine) {
//     f.number("control_period_s", engine.control_period_s, {1e-5, 1, "s"}, "period of the control engine");
//     f.integer("commands_per_tick_max", engine.commands_per_tick_max, {255, 1024}, "commands applied in one tick");
//   }
//
// When the function runs on a JSON object, each line checks type and range and stores the value. A field that is not in
// the file keeps the value it had, so that value is the default. When the function runs without an object
// (describe_fields), each line describes its field, default included; tests/config/json/schema.h writes the description
// as JSON Schema. A key that no line asks for is refused, with the nearest known key. Every object may carry a "doc"
// for people. All mistakes are added to one Problems; a line returns true when it stored the value.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "json_value.h"
#include "signal/number_text.h"

namespace kadans {

enum class Need : std::uint8_t { optional, required };

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string_view unit;
};

struct IntegerRange {
  std::uint64_t min = 0;
  std::uint64_t max = std::numeric_limits<std::uint32_t>::max();
  std::string_view unit;
};

struct CountRange {
  std::size_t min = 0;
  std::size_t max = std::numeric_limits<std::size_t>::max();
};

// A key that the file chose, with its number: {"*_knee": 0.3}.
struct NumberEntry {
  std::string key;
  double value = 0;
  TextPlace place;        // of the key
  TextPlace value_place;  // of the number
};

// A key that the file chose, with its text: {"link": "l_foot"}.
struct TextEntry {
  std::string key;
  std::string text;
  TextPlace place;       // of the key
  TextPlace text_place;  // of the text
};

// The description of a field, for the schema and the manual.
struct FieldInfo {
  enum class Kind : std::uint8_t { boolean, integer, number, string, plain, object, list, map };
  Kind kind = Kind::object;
  std::string name;
  std::string doc;
  std::string unit;
  std::string default_json;  // "" when there is none
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  CountRange count;                  // of a list's items
  std::vector<std::string> choices;  // the allowed strings; empty: any string
  std::vector<FieldInfo> fields;     // of an object; of a list or map one element, which describes its items
};

class Fields {
 public:
  // The object of a whole file.
  Fields(const JsonValue& value, Problems& problems) : value_(&value), problems_(&problems) {}
  Fields(FieldInfo& described, Problems& problems) : problems_(&problems), described_(&described) {}

  bool number(std::string_view name, double& value, NumberRange range, std::string_view doc,
              Need need = Need::optional);
  bool boolean(std::string_view name, bool& value, std::string_view doc, Need need = Need::optional);
  bool string(std::string_view name, std::string& value, std::string_view doc, Need need = Need::optional);
  bool strings(std::string_view name, std::vector<PlacedName>& values, CountRange count, std::string_view doc,
               Need need = Need::optional);
  // The file must give as many numbers as `values` has.
  bool numbers(std::string_view name, std::span<double> values, NumberRange range, std::string_view doc,
               Need need = Need::optional);
  // The file decides how many numbers it gives, within `count`.
  bool number_list(std::string_view name, std::vector<double>& values, CountRange count, NumberRange range,
                   std::string_view doc, Need need = Need::optional);
  // Reads the members of this object itself: keys are free, each value is a number.
  void number_entries(std::vector<NumberEntry>& entries, NumberRange range, std::string_view doc);
  // The same with numbers, booleans and strings as values: the object itself, for another reader; nullptr while the
  // fields are only described.
  const JsonValue* plain_entries(std::string_view doc);
  // The same with strings as values.
  void text_entries(std::vector<TextEntry>& entries, std::string_view doc);

  template <std::integral T>
  bool integer(std::string_view name, T& value, IntegerRange range, std::string_view doc, Need need = Need::optional) {
    range.max = std::min(range.max, static_cast<std::uint64_t>(std::numeric_limits<T>::max()));
    auto whole = static_cast<std::uint64_t>(value);
    const bool stored = whole_number(name, whole, range, doc, need);
    value = static_cast<T>(whole);
    return stored;
  }
  // One of `names`; the enumerators of E count from 0 in the same order.
  template <typename E>
  bool choice(std::string_view name, E& value, std::span<const std::string> names, std::string_view doc,
              Need need = Need::optional) {
    auto index = static_cast<std::size_t>(value);
    const bool stored = one_of(name, index, names, doc, need);
    value = static_cast<E>(index);
    return stored;
  }

  // read(Fields&) lists the fields of the object.
  template <typename Read>
  bool object(std::string_view name, std::string_view doc, Read&& read, Need need = Need::optional) {
    return each(open(FieldInfo::Kind::object, name, doc, {}, need), read);
  }
  // read(Fields&) lists the fields of each object in the array.
  template <typename Read>
  bool list(std::string_view name, CountRange count, std::string_view doc, Read&& read, Need need = Need::optional) {
    return each(open(FieldInfo::Kind::list, name, doc, count, need), read);
  }
  // read(Fields&, T&) lists the fields of each object in the array, which becomes the last of `items`.
  template <typename T, typename Read>
  bool list(std::string_view name, CountRange count, std::string_view doc, std::vector<T>& items, Read&& read) {
    return list(name, count, doc, [&](Fields& f) {
      T item;
      read(f, item);
      if (f.reading()) items.push_back(std::move(item));
    });
  }
  // read(Fields&) lists the fields of each object in this one, whose keys the file chose: see key().
  template <typename Read>
  bool map(std::string_view name, std::string_view doc, Read&& read, Need need = Need::optional) {
    return each(open(FieldInfo::Kind::map, name, doc, {}, need), read);
  }

  // False while the fields are only described and there is no file.
  bool reading() const noexcept { return value_ != nullptr; }
  const std::string& key() const noexcept { return key_; }  // the key of this object in its map
  TextPlace key_place() const noexcept { return key_place_; }
  TextPlace place() const noexcept { return value_ == nullptr ? TextPlace{} : value_->place; }
  bool has(std::string_view name) const { return value_ != nullptr && value_->find(name) != nullptr; }
  TextPlace place(std::string_view name) const;   // of the field's value, or of the object when the field is not given
  std::string path(std::string_view name) const;  // "plant.drives["*_knee"].viscous_Nms_per_rad"
  const std::string& path() const noexcept { return path_; }

  // Mistakes that the fields together make: of a field, told at its value, of which something MUST be; of the whole
  // object; or as it is told.
  void refuse(std::string_view name, const std::string& what) const { refuse(place(name), path(name) + what); }
  void refuse(std::string_view name, double value, const std::string& must) const {
    refuse(name, " is " + number_text(value) + ", must be " + must);
  }
  void refuse(const std::string& what) const { refuse(place(), path_ + what); }
  void refuse(TextPlace place, const std::string& message) const { problems_->add(place, message); }
  Problems& problems() const noexcept { return *problems_; }

  // Keys of this object that no field asks for are somebody else's.
  void leave_others() noexcept { any_key_ = true; }
  // After the last field: refuses the keys that no field asked for.
  void finish();

 private:
  bool whole_number(std::string_view name, std::uint64_t& value, IntegerRange range, std::string_view doc, Need need);
  bool one_of(std::string_view name, std::size_t& index, std::span<const std::string> names, std::string_view doc,
              Need need);
  std::vector<Fields> open(FieldInfo::Kind kind, std::string_view name, std::string_view doc, CountRange count,
                           Need need);
  void open_items(FieldInfo::Kind kind, const JsonValue& given, const std::string& path, CountRange count,
                  std::string_view doc, std::vector<Fields>& children);
  Fields open_child(const JsonValue& value, std::string path) const;
  const JsonValue* take(FieldInfo info, JsonValue::Kind kind, const std::string& wanted);
  bool describe_entries(FieldInfo each);
  bool is(JsonValue::Kind kind, const JsonValue& value, const std::string& path, const std::string& wanted,
          std::string_view doc) const;
  bool is_counted(const JsonValue& list, const std::string& path, CountRange count, std::string_view doc) const;
  bool read_number(const JsonValue& value, const std::string& path, NumberRange range, std::string_view doc,
                   double& result);
  bool read_numbers(const JsonValue& list, const std::string& path, NumberRange range, std::string_view doc,
                    std::span<double> results);

  template <typename Read>
  static bool each(std::vector<Fields> children, Read& read) {
    for (Fields& child : children) {
      read(child);
      child.finish();
    }
    return !children.empty();
  }

  const JsonValue* value_ = nullptr;  // an object
  Problems* problems_ = nullptr;
  FieldInfo* described_ = nullptr;
  std::string path_;
  std::string key_;
  TextPlace key_place_;
  std::vector<std::string> known_;
  bool any_key_ = false;
};

// Reads a whole file's object: read(Fields&) lists its fields.
template <typename Read>
void read_fields(const JsonValue& value, Problems& problems, Read&& read) {
  if (value.kind != JsonValue::Kind::object) {
    problems.add(value.place, "the file must hold one JSON object, in { }");
    return;
  }
  Fields fields(value, problems);
  read(fields);
  fields.finish();
}

template <typename Read>
FieldInfo describe_fields(Read&& read) {
  FieldInfo info;
  Problems problems("");  // what empty values are refused for, which nobody is told
  Fields fields(info, problems);
  read(fields);
  return info;
}

}  // namespace kadans

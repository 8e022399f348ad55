#include "kadans/campaign/parameter_edit.h"

#include <algorithm>

#include "kadans/config/fields.h"
#include "kadans/config/name_pattern.h"

namespace kadans {
namespace {

// Columns count characters, not bytes.
std::size_t offset_of(const std::string& text, TextPlace place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line; ++line) at = text.find('\n', at) + 1;
  for (int column = 1; column < place.column; ++column) {
    ++at;
    while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U) ++at;
  }
  return at;
}

const JsonMember* member(const JsonValue* value, const char* name) {
  return value == nullptr ? nullptr : value->find(name);
}

const JsonValue& object_in(const JsonValue& json, const std::string& name, const std::string& file) {
  const JsonMember* const control = json.find("control");
  const JsonMember* const objects = member(control == nullptr ? nullptr : &control->value, "objects");
  if (objects != nullptr) {
    for (const JsonValue& object : objects->value.items) {
      const JsonMember* const own = object.find("name");
      if (own != nullptr && own->value.text == name) return object;
    }
  }
  refuse(file, json.place, "there is no control object " + in_quotes(name) + " in it");
}

bool fits_any(const std::string& pattern, const std::vector<std::string>& names) {
  return std::ranges::any_of(names, [&](const std::string& name) { return matches(pattern, name); });
}

// Behind the last number as that one stands behind what is before it: on a line of its own, or on the same.
std::string added(std::string text, const JsonValue& entries, const ParameterEdit& edit) {
  const std::string entry = "\"" + edit.pattern + "\": " + number_text(edit.value);
  const JsonMember* last = nullptr;
  for (const JsonMember& one : entries.members) {
    if (one.value.kind == JsonValue::Kind::number) last = &one;
  }
  if (last == nullptr)
    return text.insert(offset_of(text, entries.place) + 1, " " + entry + (entries.members.empty() ? " " : ","));
  const std::size_t key = offset_of(text, last->place);
  const std::size_t line = text.rfind('\n', key) + 1;
  const bool own_line = text.find_first_not_of(" \t", line) == key;
  const std::string between = own_line ? ",\n" + text.substr(line, key - line) : ", ";
  return text.insert(offset_of(text, last->value.place) + last->value.text.size(), between + entry);
}

std::string edited(std::string text, const std::string& file, const ParameterEdit& edit) {
  const JsonValue json = parse_json(text, file);
  const JsonValue& object = object_in(json, edit.object, file);
  const JsonMember* const parameters = object.find("parameters");
  if (parameters == nullptr) {
    const JsonMember& first = object.members.back();
    return text.insert(offset_of(text, first.place),
                       "\"parameters\": { \"" + edit.pattern + "\": " + number_text(edit.value) + " }, ");
  }
  const JsonValue& entries = parameters->value;
  const auto same = std::ranges::find(entries.members, edit.pattern, &JsonMember::name);
  if (same == entries.members.end()) return added(std::move(text), entries, edit);
  const bool overruled = std::any_of(same + 1, entries.members.end(),
                                     [&](const JsonMember& later) { return fits_any(later.name, edit.matched); });
  if (overruled && edit.matched == std::vector{edit.pattern})
    refuse(file, same->place, in_quotes(edit.pattern) + " is overruled by an entry after it; move it to the end");
  if (overruled) {  // the same key may not stand twice: each parameter by its own name
    for (const std::string& name : edit.matched)
      text = edited(std::move(text), file, {edit.object, name, {name}, edit.value});
    return text;
  }
  return text.replace(offset_of(text, same->value.place), same->value.text.size(), number_text(edit.value));
}

}  // namespace

std::string edit_parameters(const std::string& text, const std::string& file, const std::vector<ParameterEdit>& edits) {
  std::string all = text;
  for (const ParameterEdit& edit : edits) all = edited(std::move(all), file, edit);
  return all;
}

}  // namespace kadans

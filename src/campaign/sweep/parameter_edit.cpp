#include "parameter_edit.h"

#include <algorithm>

#include "config/json/fields.h"
#include "config/json/json_edit.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

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
std::string added(std::string text, const JsonValue& entries, const std::string& name, double value) {
  const std::string entry = "\"" + name + "\": " + number_text(value);
  const JsonMember* last = nullptr;
  for (const JsonMember& one : entries.members) {
    if (one.value.kind == JsonValue::Kind::number) last = &one;
  }
  if (last == nullptr)
    return text.insert(offset_of(text, entries.place) + 1, " " + entry + (entries.members.empty() ? " " : ","));
  const auto indent = own_indent(text, offset_of(text, last->place));
  const std::string between = indent ? ",\n" + *indent : ", ";
  return text.insert(offset_of(text, last->value.place) + last->value.text.size(), between + entry);
}

std::string replaced(std::string text, const JsonValue& number, double value) {
  return text.replace(offset_of(text, number.place), number.text.size(), number_text(value));
}

// The numbers that the edit goes among; nullptr: the object has no parameters yet.
const JsonValue* entries_of(const JsonValue& object, const std::string& file, const ParameterEdit& edit) {
  if (edit.preset.empty()) {
    const JsonMember* const parameters = object.find("parameters");
    return parameters == nullptr ? nullptr : &parameters->value;
  }
  const JsonMember* const presets = object.find("presets");
  const JsonMember* const preset = presets == nullptr ? nullptr : presets->value.find(edit.preset);
  if (preset == nullptr)
    refuse(file, object.place,
           "control object " + in_quotes(edit.object) + " has no preset " + in_quotes(edit.preset) + " in it");
  return &preset->value;
}

std::string edited(std::string text, const std::string& file, const ParameterEdit& edit) {
  const JsonValue json = parse_json(text, file);
  const JsonValue& object = object_in(json, edit.object, file);
  const JsonValue* const entries = entries_of(object, file, edit);
  if (entries == nullptr) {
    const JsonMember& last = object.members.back();
    return text.insert(offset_of(text, last.place),
                       "\"parameters\": { \"" + edit.pattern + "\": " + number_text(edit.value) + " }, ");
  }
  const auto same = std::ranges::find(entries->members, edit.pattern, &JsonMember::name);
  if (same == entries->members.end()) return added(std::move(text), *entries, edit.pattern, edit.value);
  const bool overruled = std::any_of(same + 1, entries->members.end(),
                                     [&](const JsonMember& later) { return fits_any(later.name, edit.matched); });
  if (overruled && edit.matched == std::vector{edit.pattern})
    refuse(file, same->place, in_quotes(edit.pattern) + " is overruled by an entry after it; move it to the end");
  if (overruled) {  // the same key may not stand twice: each parameter by its own name
    for (const std::string& name : edit.matched)
      text = edited(std::move(text), file, {edit.object, name, {name}, edit.value, edit.preset});
    return text;
  }
  return replaced(std::move(text), same->value, edit.value);
}

// An entry before a key: on a line of its own as that one, above what is said about it, or on the same line.
std::string put_before(std::string text, std::size_t key, const std::string& entry) {
  const auto indent = own_indent(text, key);
  if (!indent) return text.insert(key, entry + ", ");
  std::size_t line = key - indent->size();
  while (line > 1) {
    const std::size_t above = text.rfind('\n', line - 2) + 1;
    if (text.compare(text.find_first_not_of(" \t", above), 2, "//") != 0) break;
    line = above;
  }
  return text.insert(line, *indent + entry + ",\n");
}

std::string with_behaviors(std::string text, const JsonValue& json, const std::string& entry) {
  const std::string behaviors = "\"behaviors\": { " + entry + " }";
  if (json.members.empty()) return text.insert(offset_of(text, json.place) + 1, " " + behaviors + " ");
  const std::size_t key = offset_of(text, json.members.back().place);
  return put_before(std::move(text), key, behaviors);
}

std::string edited(std::string text, const std::string& file, const BehaviorEdit& edit) {
  const JsonValue json = parse_json(text, file);
  const std::string entry =
      "\"" + edit.behavior + "\": { \"" + edit.parameter + "\": " + number_text(edit.value) + " }";
  const JsonMember* const behaviors = json.find("behaviors");
  if (behaviors == nullptr) return with_behaviors(std::move(text), json, entry);
  const JsonMember* const own = behaviors->value.find(edit.behavior);
  if (own == nullptr) {
    const std::vector<JsonMember>& others = behaviors->value.members;
    if (others.empty()) return text.insert(offset_of(text, behaviors->value.place) + 1, " " + entry + " ");
    const std::size_t key = offset_of(text, others.front().place);
    return put_before(std::move(text), key, entry);
  }
  const JsonMember* const same = own->value.find(edit.parameter);
  return same == nullptr ? added(std::move(text), own->value, edit.parameter, edit.value)
                         : replaced(std::move(text), same->value, edit.value);
}

template <typename Edit>
std::string all_edited(std::string text, const std::string& file, const std::vector<Edit>& edits) {
  for (const Edit& edit : edits) text = edited(std::move(text), file, edit);
  return text;
}

}  // namespace

std::string edit_parameters(const std::string& text, const std::string& file, const std::vector<ParameterEdit>& edits) {
  return all_edited(text, file, edits);
}

std::string edit_behaviors(const std::string& text, const std::string& file, const std::vector<BehaviorEdit>& edits) {
  return all_edited(text, file, edits);
}

}  // namespace kadans

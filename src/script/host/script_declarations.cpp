#include "script_declarations.h"

#include <algorithm>
#include <cmath>

#include "config/json/problems.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Field = ScriptEvent::Field;

Field::Type kind_of(const PlayValue& value) noexcept {
  constexpr Field::Type types[] = {Field::Type::number, Field::Type::flag, Field::Type::text};
  return types[value.index()];
}

std::string range_text(const Field& field) {
  const bool low = std::isfinite(field.min), high = std::isfinite(field.max);
  if (!low && !high) return "";
  return ", " + (low ? number_text(field.min) : "") + ".." + (high ? number_text(field.max) : "");
}

std::string field_text(const Field& field) {
  const bool unit = field.type == Field::Type::number && !field.unit.empty();
  return field.name + ": " + type_text(field.type) + (unit ? " in " + field.unit : "") +
         (field.type == Field::Type::number ? range_text(field) : "") + (field.optional ? ", optional" : "");
}

std::string wrong_value(const Field& field, const PlayValue& value) {
  if (kind_of(value) != field.type)
    return "must be " + std::string(type_text(field.type)) + (field.unit.empty() ? "" : " in " + field.unit);
  const auto* number = std::get_if<double>(&value);
  if (number == nullptr || (*number >= field.min && *number <= field.max)) return "";
  return "= " + number_text(*number) + " is outside its range" + range_text(field).substr(1) +
         (field.unit.empty() ? "" : " " + field.unit);
}

}  // namespace

const char* type_text(Field::Type type) noexcept {
  constexpr const char* texts[] = {"a number", "true or false", "a text"};
  return texts[static_cast<std::size_t>(type)];
}

std::string fields_text(const ScriptEvent& event) { return listed(event.fields, field_text, "; "); }

WrongData wrong_data(const ScriptEvent& declared, const PlayedEvent& event) {
  const std::string of = "event '" + declared.name + "': ";
  for (const PlayArgument& given : event.data) {
    const auto field = std::ranges::find(declared.fields, given.name, &Field::name);
    if (field == declared.fields.end()) {
      const std::string fields = fields_text(declared);
      return {of + "no field " + in_quotes(given.name) + (fields.empty() ? "; it has no data" : "; there is " + fields),
              given.place};
    }
    if (const std::string why = wrong_value(*field, given.value); !why.empty())
      return {of + "field '" + given.name + "' " + why, given.place};
  }
  for (const Field& field : declared.fields) {
    const bool given = std::ranges::find(event.data, field.name, &PlayArgument::name) != event.data.end();
    if (!given && !field.optional)
      return {of + "field '" + field.name + "' is missing; " + field_text(field), event.place};
  }
  return {};
}

const ScriptEvent* find_event(const std::vector<ScriptEvent>& events, std::string_view name) noexcept {
  const auto found = std::ranges::find(events, name, &ScriptEvent::name);
  return found == events.end() ? nullptr : &*found;
}

}  // namespace kadans

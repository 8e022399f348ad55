// The texts of messages about fields, and the descriptions of fields.
#pragma once

#include <string>
#include <string_view>

#include "fields.h"

namespace kadans {

// "plant.drives" and "*_knee" -> plant.drives['*_knee']
std::string key_path(const std::string& path, std::string_view name);
// Describes a value for a message: "the number 3", "an array".
std::string described(const JsonValue& value);
// "must be 0..1 rad", "must be at least 0 Nm". An empty string means no limit.
std::string range_text(const std::string& min, const std::string& max, std::string_view unit);
std::string range_text(const NumberRange& range);
// "has 5 items, must be 0..4"
std::string count_text(std::size_t found, CountRange count);
// ": what the field means"
std::string with_doc(std::string_view doc);

FieldInfo info_of(FieldInfo::Kind kind, std::string_view name, std::string_view doc, Need need);
FieldInfo number_info(std::string_view name, NumberRange range, std::string_view doc, Need need);

}  // namespace kadans

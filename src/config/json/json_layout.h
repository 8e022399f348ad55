// Writes a JSON tree as the files of this project are laid out: what fits stands on one line, except for lists of
// objects, which have a line for each. Numbers stay as they were written.
#pragma once

#include <string>

#include "json_value.h"

namespace kadans {

std::string laid_out(const JsonValue& value);  // with a line end

// Parts of trees that are put together.
JsonValue json_string(std::string text);
JsonValue json_number(double value);  // with as few digits as name it
JsonValue json_list(std::vector<JsonValue> items);
// The member of an object, which gets one when it has none.
JsonValue& member_of(JsonValue& object, const std::string& name);
void erase_member(JsonValue& object, std::string_view name);

}  // namespace kadans

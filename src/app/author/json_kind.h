// Tells the kind of one of our JSON files by its keys, for a command that was given the wrong kind.
#pragma once

#include <cstdint>
#include <filesystem>

#include "config/json/json_value.h"

namespace kadans {

enum class JsonKind : std::uint8_t { other, scenario, robot, sweep, tuning };

JsonKind kind_of(const JsonValue& json);
// Throws InputError for a file of another kind; the message says what it is and which command takes it. A file that
// cannot be read, or whose kind is unknown, passes: its reader refuses it.
void require_kind(const std::filesystem::path& file, JsonKind wanted);

}  // namespace kadans

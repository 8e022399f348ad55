// Which of our JSON files one is, by its keys: for a command that was given one of another kind.
#pragma once

#include <cstdint>
#include <filesystem>

#include "kadans/config/json_value.h"

namespace kadans {

enum class JsonKind : std::uint8_t { other, scenario, robot, sweep, tuning };

JsonKind kind_of(const JsonValue& json);
// Throws InputError that says what it is and which command takes it. A file that cannot be read, or that nobody knows,
// is for its reader to refuse.
void require_kind(const std::filesystem::path& file, JsonKind wanted);

}  // namespace kadans

// JSON from outside of the process (clients, records, other processes' reports) as trees of nlohmann-json, and trees as
// text. That library bounds nothing by itself: its trees are copied and written by recursion, its messages quote what
// came, and it refuses to write a text that is not UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace kadans {

// Values nest at most json_depth_max deep (kadans/config/json_value.h). Nothing: it is no JSON, or nests deeper.
std::optional<nlohmann::ordered_json> read_foreign_json(std::string_view text);

// The same; throws InputError with the place, and never a word of the text. `file` only names it.
nlohmann::ordered_json parse_foreign_json(std::string_view text, const std::string& file = "");

// On one line, or indented by so many blanks. Bytes that are not UTF-8 become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace kadans

// Reads JSON from outside the process (clients, records, reports of other processes) into trees of nlohmann-json, and
// writes such trees as text. The library itself has no bounds: it copies and writes trees by recursion, its messages
// quote the input, and it refuses to write a text that is not UTF-8. These functions add the bounds.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace kadans {

// nullopt when the text is no JSON, or when its values nest deeper than json_depth_max (config/json/json_value.h).
std::optional<nlohmann::ordered_json> read_foreign_json(std::string_view text);

// The same, but throws InputError with the place. The message never quotes the text. `file` only names it.
nlohmann::ordered_json parse_foreign_json(std::string_view text, const std::string& file = "");

// Writes the tree on one line (indent -1) or indented by `indent` blanks. Bytes that are not UTF-8 become U+FFFD, and
// characters that a terminal would obey are escaped.
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

}  // namespace kadans

// JSON as text that every reader takes: names of files, and what scripts and strangers say, need not be UTF-8, which
// JSON has to be. What is not becomes U+FFFD.
#pragma once

namespace kadans {

// One line, or indented. `Json` is nlohmann's.
template <typename Json>
auto json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kadans

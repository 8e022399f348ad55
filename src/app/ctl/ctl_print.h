// Prints answers of a running instance for people.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace kadans {

using Json = nlohmann::ordered_json;

// `words` is the verb on the command line, such as "record stop". The text ends with a newline, or is empty.
std::string answer_text(const std::string& words, const Json& answer);
std::string watch_head(const Json& answer);  // with a newline
std::string watch_line(const Json& sample);  // without a newline

}  // namespace kadans

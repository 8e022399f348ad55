// Compares the formats of string.format and k.log with the values behind them, as far as they are written out.
#pragma once

#include <string>
#include <vector>

#include "source_lexer.h"

namespace kadans {

// `at` is the first token in the brackets of the call. "" when nothing is wrong.
std::string format_mistake(const std::vector<SourceToken>& tokens, std::size_t at, const std::string& called);

// print("x %d", 1)
std::string print_mistake(const std::vector<SourceToken>& tokens, std::size_t at);

}  // namespace kadans

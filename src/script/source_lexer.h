// Lua source taken apart into tokens, for checks that look at a script without running it.
#pragma once

#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

inline bool starts_name(char c) noexcept { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; }

struct SourceToken {
  enum class Kind : std::uint8_t { name, keyword, text, number, symbol, end };
  Kind kind = Kind::end;
  std::string text;  // of a string: what stands between the quotes, escapes as written
  int line = 0;

  bool is(std::string_view wanted) const noexcept {
    return (kind == Kind::keyword || kind == Kind::symbol) && text == wanted;
  }
};

// Comments are left out; the last token is of kind `end`. The text has been compiled before, so it is well formed.
std::vector<SourceToken> lex_source(std::string_view text);

// The token behind the arguments of a call; `at` is the first token in its bracket, or the text or table without one.
std::size_t end_of_call(const std::vector<SourceToken>& tokens, std::size_t at);

// The first tokens of what stands in a bracket, commas or semicolons between; `at` is the first one of all.
std::vector<std::size_t> parts_of(const std::vector<SourceToken>& tokens, std::size_t at);

// The first tokens of the values behind an '=', commas between, then the token behind them all; `at` is the first one.
std::vector<std::size_t> values_of(const std::vector<SourceToken>& tokens, std::size_t at);

}  // namespace kadans

// Splits Lua source into tokens, for checks that read a script without running it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace kadans {

inline bool starts_name(char c) noexcept { return c == '_' || std::isalpha(static_cast<unsigned char>(c)) != 0; }
inline bool in_name(char c) noexcept { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; }

bool is_keyword(std::string_view word) noexcept;

struct SourceToken {
  enum class Kind : std::uint8_t { name, keyword, text, number, symbol, end };
  Kind kind = Kind::end;
  std::string text;  // of a string: the text between the quotes, with escapes as written
  int line = 0;

  bool is(std::string_view wanted) const noexcept {
    return (kind == Kind::keyword || kind == Kind::symbol) && text == wanted;
  }
  bool is_name(std::string_view wanted) const noexcept { return kind == Kind::name && text == wanted; }
  // A value that is written out, but for nil.
  bool is_literal() const noexcept { return kind == Kind::number || kind == Kind::text || is("true") || is("false"); }
  bool is_any(std::initializer_list<std::string_view> wanted) const noexcept {
    return std::ranges::any_of(wanted, [&](std::string_view one) { return is(one); });
  }
};
using TokenKind = SourceToken::Kind;
using Tokens = std::vector<SourceToken>;

// Comments are left out; the last token is of kind `end`. The text has been compiled before, so it is well formed.
Tokens lex_source(std::string_view text);

// The index of the token after the arguments of a call. `at` is the first token in the bracket, or the string or table
// of a call without brackets.
std::size_t end_of_call(const Tokens& tokens, std::size_t at);

// The text of a line, the first of which is 1, without its end.
std::string_view line_of_text(std::string_view text, int line) noexcept;

// The index of the token that closes what opens at `at`: a bracket, a function, an if, a loop's `do` or `repeat`.
std::size_t end_of_block(const Tokens& tokens, std::size_t at);

// Whether the token opens a block, a bracket or either of them (1), closes one (-1), or neither (0).
int opens_block(const SourceToken& token);
int opens_bracket(const SourceToken& token);
inline int opens(const SourceToken& token) { return opens_block(token) + opens_bracket(token); }

// The first tokens of the parts in a bracket, which are separated by commas or semicolons. `at` is the first of all.
std::vector<std::size_t> parts_of(const Tokens& tokens, std::size_t at);

// The first tokens of the values after an '=', which are separated by commas, and then the token after them all. `at`
// is the first one.
std::vector<std::size_t> values_of(const Tokens& tokens, std::size_t at);

}  // namespace kadans

// Explains a syntax error to an author who writes another language out of habit, or who forgot a comma, an `end` or a
// bracket. Lua's own message says what the compiler expected where it gave up; the hint says what was meant, and where.
#pragma once

#include <array>
#include <string_view>

namespace kadans {

struct SyntaxHint {
  int line = 0;                  // the one that the author must change
  std::array<char, 256> text{};  // "" when the place tells nothing
};

// `text` did not compile; `line` and `message` are Lua's: "'then' expected near '!'".
SyntaxHint syntax_hint(std::string_view text, int line, std::string_view message);

}  // namespace kadans

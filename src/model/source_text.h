// The text of a file from outside: checks that it is text, and finds the line and column of a byte.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "signal/text_place.h"

namespace kadans {

struct TextProblem {
  std::size_t at = 0;  // byte
  std::string message;
};

class SourceText {
 public:
  explicit SourceText(std::string_view text);  // keeps a view

  std::string_view text() const noexcept { return text_; }
  TextPlace place(std::size_t at) const noexcept;

 private:
  std::string_view text_;
  std::vector<std::size_t> lines_;  // where each line starts
};

inline constexpr std::string_view xml_blanks = " \t\r\n";

// The first byte that is not UTF-8, or a control character other than tab, line feed and carriage return.
std::optional<TextProblem> find_non_text(std::string_view text);

// For a message: without control characters, cut after 40 characters.
std::string shown(std::string_view text);
inline std::string shown_quoted(std::string_view name) { return "'" + shown(name) + "'"; }

}  // namespace kadans

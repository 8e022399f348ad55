// Walks over a text and always knows its current line and column. Columns count characters, not bytes.
#pragma once

#include <cstddef>
#include <string_view>

#include "problems.h"

namespace kadans {

class TextCursor {
 public:
  explicit TextCursor(std::string_view text) noexcept : text_(text) {}

  bool at_end() const noexcept { return position_ >= text_.size(); }
  // The character `ahead` places after the cursor; '\0' past the end of the text.
  char peek(std::size_t ahead = 0) const noexcept {
    return ahead < text_.size() - position_ ? text_[position_ + ahead] : '\0';
  }
  char next() noexcept {
    const char c = text_[position_++];
    place_.pass(c);
    return c;
  }
  std::size_t position() const noexcept { return position_; }
  std::string_view since(std::size_t start) const noexcept { return text_.substr(start, position_ - start); }
  TextPlace place() const noexcept { return place_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  TextPlace place_{1, 1};
};

}  // namespace kadans

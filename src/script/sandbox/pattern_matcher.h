// Matches Lua's patterns (Lua 5.1 manual, 5.4.1) under the budget. Each compared character and each item is a step that
// is charged, so a pattern that backtracks without end is stopped.
//
// The meaning of a pattern, its end ('\0') and the mistakes that raise are the same as in LuaJIT 2.1; the fuzzer
// tests/fuzz/lua_pattern.cpp compares the two. Each nested item needs C stack, so nesting is limited to 200.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "script/lua/lua_core.h"

namespace kadans {

// A set of characters, one bit for each.
class CharacterSet {
 public:
  constexpr void add(unsigned char c) noexcept { words_[c / 64] |= std::uint64_t{1} << (c % 64); }
  constexpr void add(unsigned char first, unsigned char last) noexcept {
    for (unsigned word = first / 64; first <= last && word <= last / 64U; ++word) {
      const unsigned from = word == first / 64U ? first % 64U : 0, to = word == last / 64U ? last % 64U : 63;
      words_[word] |= ~std::uint64_t{0} << from & ~std::uint64_t{0} >> (63 - to);
    }
  }
  constexpr void add_all(const CharacterSet& other, bool inverted) noexcept {
    for (std::size_t i = 0; i < words_.size(); ++i) words_[i] |= inverted ? ~other.words_[i] : other.words_[i];
  }
  constexpr void invert() noexcept {
    for (std::uint64_t& word : words_) word = ~word;
  }
  constexpr bool has(unsigned char c) const noexcept { return (words_[c / 64] >> (c % 64) & 1U) != 0; }

 private:
  std::array<std::uint64_t, 4> words_{};
};

class PatternMatcher {
 public:
  // Subject and pattern must stay on the stack of `state` meanwhile. `pattern` is without its anchor.
  PatternMatcher(lua_State* state, std::string_view subject, const char* pattern) noexcept
      : state_(state),
        meter_(state),
        pattern_(pattern),
        first_(subject.data()),
        last_(subject.data() + subject.size()) {}

  // Finds the first match at or after `from`; when anchored, only a match at `from`. False: there is none. Raises on a
  // wrong pattern.
  bool find(const char* from, bool anchored);
  const char* begin() const noexcept { return begin_; }
  const char* end() const noexcept { return end_; }

  // [-0 +1] Pushes capture `index` of the last match, counted from 0; without captures, 0 is the whole match. Raises
  // when there is no such capture.
  void push_capture(int index);
  // [-0 +n] Pushes all captures; the whole match when there are none and `whole` is true.
  int push_captures(bool whole);
  // To be called after the last match: charges the rest.
  void settle() { meter_.settle(); }
  StepMeter& meter() noexcept { return meter_; }

 private:
  static constexpr int captures_max = 32, depth_max = 200;
  static constexpr std::ptrdiff_t open = -1, position = -2;  // special values of a length
  // Steps for an item and the call that continues after it, for a character of a run, for a character of a set, for a
  // capture.
  static constexpr std::size_t item_steps = 20, run_steps = 3, set_steps = 6, capture_steps = 64;
  struct Capture {
    const char* begin;
    std::ptrdiff_t length;
  };
  struct Set {
    const char* item;  // its '['
    const char* rest;  // after its ']'
    CharacterSet set;
  };

  const char* match(const char* at, const char* item);
  const char* match_items(const char* at, const char* item);
  const char* match_paired(const char* at, const char*& item);
  const char* match_balanced(const char* at, const char* pair);
  bool at_frontier(const char* at, const char* item);
  const char* match_again(const char* at, char digit);
  const char* match_most(const char* at, const char* item, const char* rest);
  const char* match_least(const char* at, const char* item, const char* rest);
  const char* begin_capture(const char* at, const char* rest, std::ptrdiff_t kind);
  const char* end_capture(const char* at, const char* rest);
  const char* behind_item(const char* item);
  const Set& set_at(const char* item);
  bool fits(const char* at, const char* item);

  lua_State* state_;
  StepMeter meter_;
  const char* pattern_;
  const char* first_;  // of the subject
  const char* last_;   // one past its end, where a '\0' is
  const char* begin_ = nullptr;
  const char* end_ = nullptr;
  int depth_ = 0, level_ = 0;
  std::size_t sets_read_ = 0;
  std::array<Set, 4> sets_{};
  std::array<Capture, captures_max> captures_;
};

}  // namespace kadans

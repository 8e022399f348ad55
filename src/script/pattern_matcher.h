// Lua's patterns (Lua 5.1 manual, 5.4.1), matched step by step under the budget: each character compared and each item
// looked at is a step that is charged, so a pattern that backtracks for ever ends in the middle.
//
// What a pattern means, where it ends ('\0') and which mistakes raise is as in LuaJIT 2.1; the fuzzer of
// tests/fuzz/lua_pattern.cpp compares the two. Nested items take a piece of the C stack each, 200 deep at most.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "step_meter.h"

namespace kadans {

// Characters, a bit each.
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
  // Subject and pattern stay on the stack of `state` meanwhile. The pattern is without its anchor.
  PatternMatcher(lua_State* state, std::string_view subject, const char* pattern) noexcept
      : state_(state),
        meter_(state),
        pattern_(pattern),
        first_(subject.data()),
        last_(subject.data() + subject.size()) {}

  // The first match at or behind `from`; only one at `from` when it is anchored. False: there is none. Raises what is
  // wrong with the pattern.
  bool find(const char* from, bool anchored);
  const char* begin() const noexcept { return begin_; }
  const char* end() const noexcept { return end_; }

  // Of the last match. [-0 +1] Capture `index` from 0 on; without captures 0 is the whole match. Raises when there is
  // none.
  void push_capture(int index);
  // [-0 +n] All captures; the whole match when there are none and it is wanted.
  int push_captures(bool whole);
  // Behind the last match: charges the rest.
  void settle() { meter_.settle(); }
  StepMeter& meter() noexcept { return meter_; }

 private:
  static constexpr int captures_max = 32, depth_max = 200;
  static constexpr std::ptrdiff_t open = -1, position = -2;  // in place of a length
  // For an item with the call that goes on behind it, a character of a run, one of a set that is read, a capture.
  static constexpr std::size_t item_steps = 20, run_steps = 3, set_steps = 6, capture_steps = 64;
  struct Capture {
    const char* begin;
    std::ptrdiff_t length;
  };
  struct Set {
    const char* item;  // its '['
    const char* rest;  // behind its ']'
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
  const char* last_;   // behind it; '\0' stands there
  const char* begin_ = nullptr;
  const char* end_ = nullptr;
  int depth_ = 0, level_ = 0;
  std::size_t sets_read_ = 0;
  std::array<Set, 4> sets_{};
  std::array<Capture, captures_max> captures_;
};

}  // namespace kadans

#include "pattern_matcher.h"

#include <cstring>
#include <string_view>

namespace kadans {
namespace {

constexpr bool in_range(int c, int first, int last) noexcept { return c >= first && c <= last; }
constexpr bool is_letter(int c) noexcept { return in_range(c, 'a', 'z') || in_range(c, 'A', 'Z'); }
constexpr bool is_digit(int c) noexcept { return in_range(c, '0', '9'); }
constexpr bool is_visible(int c) noexcept { return in_range(c, '!', '~'); }

// Of ASCII, whatever the locale.
constexpr bool in_class(int c, char letter) noexcept {
  switch (letter) {
    case 'a':
      return is_letter(c);
    case 'c':
      return c < ' ' || c == 127;
    case 'd':
      return is_digit(c);
    case 'g':
      return is_visible(c);
    case 'l':
      return in_range(c, 'a', 'z');
    case 'p':
      return is_visible(c) && !is_letter(c) && !is_digit(c);
    case 's':
      return in_range(c, '\t', '\r') || c == ' ';
    case 'u':
      return in_range(c, 'A', 'Z');
    case 'w':
      return is_letter(c) || is_digit(c);
    case 'x':
      return is_digit(c) || in_range(c, 'a', 'f') || in_range(c, 'A', 'F');
    default:
      return letter == 'z' && c == '\0';
  }
}

constexpr std::string_view class_letters = "acdglpsuwxz";

// By the lower five bits of a class's letter; empty where there is no such class.
constexpr std::array<CharacterSet, 32> make_classes() noexcept {
  std::array<CharacterSet, 32> classes{};
  for (const char letter : class_letters) {
    for (int c = 0; c < 256; ++c) {
      if (in_class(c, letter)) classes[letter & 31].add(static_cast<unsigned char>(c));
    }
  }
  return classes;
}
constexpr std::array<CharacterSet, 32> classes = make_classes();

constexpr std::array<bool, 256> make_names() noexcept {
  std::array<bool, 256> names{};
  for (const char letter : class_letters) {
    const auto lower = static_cast<unsigned char>(letter);
    names[lower] = names[lower - 'a' + 'A'] = true;
  }
  return names;
}
constexpr std::array<bool, 256> names_class = make_names();

// %a and its kin; another character behind '%' is meant itself.
bool fits_class(unsigned char c, unsigned char escaped) noexcept {
  if (!names_class[escaped]) return c == escaped;
  return classes[escaped & 31].has(c) == ((escaped & 32) != 0);
}

void add_class(CharacterSet& set, unsigned char escaped) noexcept {
  if (!names_class[escaped]) return set.add(escaped);
  set.add_all(classes[escaped & 31], (escaped & 32) == 0);
}

// What is between the '[' at `item` and the ']' at `last`.
CharacterSet read_set(const char* item, const char* last) noexcept {
  CharacterSet set;
  const bool inverted = item[1] == '^';
  for (const char* at = item + (inverted ? 2 : 1); at < last; ++at) {
    if (*at == '%') {
      add_class(set, static_cast<unsigned char>(*++at));
    } else if (at[1] == '-' && at + 2 < last) {
      set.add(static_cast<unsigned char>(at[0]), static_cast<unsigned char>(at[2]));
      at += 2;
    } else {
      set.add(static_cast<unsigned char>(*at));
    }
  }
  if (inverted) set.invert();
  return set;
}

}  // namespace

bool PatternMatcher::find(const char* from, bool anchored) {
  for (const char* at = from; at <= last_; ++at) {
    depth_ = level_ = 0;
    end_ = match(at, pattern_);
    begin_ = at;
    if (end_ != nullptr) return true;
    if (anchored) return false;
  }
  return false;
}

// Where the match of the pattern from `item` on ends, of the subject from `at` on; nullptr: it does not match.
const char* PatternMatcher::match(const char* at, const char* item) {
  if (++depth_ > depth_max) luaL_error(state_, "pattern too complex");
  const char* const end = match_items(at, item);
  --depth_;
  return end;
}

const char* PatternMatcher::match_items(const char* at, const char* item) {
  for (;;) {
    meter_.spend(item_steps);
    switch (*item) {
      case '\0':
        return at;
      case '(':
        return item[1] == ')' ? begin_capture(at, item + 2, position) : begin_capture(at, item + 1, open);
      case ')':
        return end_capture(at, item + 1);
      case '$':
        if (item[1] != '\0') break;
        return at == last_ ? at : nullptr;
      case '%':
        if (item[1] != 'b' && item[1] != 'f' && !is_digit(item[1])) break;
        at = match_paired(at, item);
        if (at == nullptr) return nullptr;
        continue;
      default:
        break;
    }
    const char* const rest = behind_item(item);
    if (*rest == '*') return match_most(at, item, rest + 1);
    if (*rest == '-') return match_least(at, item, rest + 1);
    const bool one = fits(at, item);
    if (*rest == '+') return one ? match_most(at + 1, item, rest + 1) : nullptr;
    if (*rest == '?') {
      const char* const end = one ? match(at + 1, rest + 1) : nullptr;
      if (end != nullptr) return end;
      item = rest + 1;
    } else if (one) {
      ++at;
      item = rest;
    } else {
      return nullptr;
    }
  }
}

// %b, %f and %1; `item` goes on behind it.
const char* PatternMatcher::match_paired(const char* at, const char*& item) {
  if (item[1] == 'b') {
    const char* const pair = item + 2;
    item += 4;
    return match_balanced(at, pair);
  }
  if (item[1] == 'f') {
    const char* const set = item + 2;
    if (*set != '[') luaL_error(state_, "missing '[' after '%%f' in pattern");
    item = behind_item(set);
    return at_frontier(at, set) ? at : nullptr;
  }
  const char digit = item[1];
  item += 2;
  return match_again(at, digit);
}

const char* PatternMatcher::match_balanced(const char* at, const char* pair) {
  if (pair[0] == '\0' || pair[1] == '\0') luaL_error(state_, "unbalanced pattern");
  if (*at != pair[0]) return nullptr;
  int depth = 1;
  while (++at < last_) {
    meter_.spend(run_steps);
    if (*at == pair[1]) {
      if (--depth == 0) return at + 1;
    } else if (*at == pair[0]) {
      ++depth;
    }
  }
  return nullptr;
}

// Where the set begins to fit; before and behind the subject stands a '\0'.
bool PatternMatcher::at_frontier(const char* at, const char* item) {
  meter_.spend(item_steps);
  const CharacterSet& set = set_at(item).set;
  return !set.has(static_cast<unsigned char>(at == first_ ? '\0' : at[-1])) && set.has(static_cast<unsigned char>(*at));
}

// What a capture caught, once more.
const char* PatternMatcher::match_again(const char* at, char digit) {
  const int index = digit - '1';
  if (index < 0 || index >= level_ || captures_[static_cast<std::size_t>(index)].length == open)
    luaL_error(state_, "invalid capture index");
  const Capture& caught = captures_[static_cast<std::size_t>(index)];
  if (caught.length < 0 || last_ - at < caught.length) return nullptr;
  const auto length = static_cast<std::size_t>(caught.length);
  meter_.spend(StepMeter::of_bytes(length));
  return std::memcmp(caught.begin, at, length) == 0 ? at + length : nullptr;
}

// '*': as many as fit, then fewer.
const char* PatternMatcher::match_most(const char* at, const char* item, const char* rest) {
  const char* end = at;
  if (*item == '.') {
    end = last_;
  } else if (*item == '[') {
    const CharacterSet& set = set_at(item).set;
    while (end < last_ && set.has(static_cast<unsigned char>(*end))) ++end;
  } else {
    while (fits(end, item)) ++end;
  }
  meter_.spend(run_steps * static_cast<std::size_t>(end - at));
  for (; end >= at; --end) {
    const char* const matched = match(end, rest);
    if (matched != nullptr) return matched;
  }
  return nullptr;
}

// '-': as few as will do.
const char* PatternMatcher::match_least(const char* at, const char* item, const char* rest) {
  for (;; ++at) {
    const char* const end = match(at, rest);
    if (end != nullptr) return end;
    if (!fits(at, item)) return nullptr;
  }
}

const char* PatternMatcher::begin_capture(const char* at, const char* rest, std::ptrdiff_t kind) {
  if (level_ >= captures_max) luaL_error(state_, "too many captures");
  captures_[static_cast<std::size_t>(level_++)] = {at, kind};
  const char* const end = match(at, rest);
  if (end == nullptr) --level_;
  return end;
}

const char* PatternMatcher::end_capture(const char* at, const char* rest) {
  int index = level_ - 1;
  while (index >= 0 && captures_[static_cast<std::size_t>(index)].length != open) --index;
  if (index < 0) luaL_error(state_, "invalid pattern capture");
  Capture& capture = captures_[static_cast<std::size_t>(index)];
  capture.length = at - capture.begin;
  const char* const end = match(at, rest);
  if (end == nullptr) capture.length = open;
  return end;
}

const char* PatternMatcher::behind_item(const char* item) {
  if (*item == '[') return set_at(item).rest;
  if (*item != '%') return item + 1;
  if (item[1] == '\0') luaL_error(state_, "malformed pattern (ends with '%%')");
  return item + 2;
}

// The set that begins at `item`: read once, and again when four others were read meanwhile.
const PatternMatcher::Set& PatternMatcher::set_at(const char* item) {
  for (const Set& known : sets_) {
    if (known.item == item) return known;
  }
  const char* at = item + (item[1] == '^' ? 2 : 1);
  do {  // a ']' at once is meant itself
    if (*at == '\0') luaL_error(state_, "malformed pattern (missing ']')");
    if (*at++ == '%' && *at != '\0') ++at;
  } while (*at != ']');
  meter_.spend(set_steps * static_cast<std::size_t>(at - item));
  Set& made = sets_[sets_read_++ % sets_.size()];
  made = {item, at + 1, read_set(item, at)};
  return made;
}

// Whether the character at `at`, if there is one, fits the single item.
bool PatternMatcher::fits(const char* at, const char* item) {
  if (at >= last_) return false;
  const auto c = static_cast<unsigned char>(*at);
  switch (*item) {
    case '.':
      return true;
    case '%':
      return fits_class(c, static_cast<unsigned char>(item[1]));
    case '[':
      return set_at(item).set.has(c);
    default:
      return static_cast<unsigned char>(*item) == c;
  }
}

void PatternMatcher::push_capture(int index) {
  meter_.spend(capture_steps);
  if (index >= level_) {
    if (index != 0) luaL_error(state_, "invalid capture index");
    const auto length = static_cast<std::size_t>(end_ - begin_);
    meter_.spend(StepMeter::of_bytes(length));
    return lua_pushlstring(state_, begin_, length);
  }
  const Capture& capture = captures_[static_cast<std::size_t>(index)];
  if (capture.length == open) luaL_error(state_, "unfinished capture");
  if (capture.length == position) return lua_pushinteger(state_, capture.begin - first_ + 1);
  meter_.spend(StepMeter::of_bytes(static_cast<std::size_t>(capture.length)));
  lua_pushlstring(state_, capture.begin, static_cast<std::size_t>(capture.length));
}

int PatternMatcher::push_captures(bool whole) {
  const int count = level_ == 0 && whole ? 1 : level_;
  luaL_checkstack(state_, count, "too many captures");
  for (int index = 0; index < count; ++index) push_capture(index);
  return count;
}

}  // namespace kadans

// Reads a JSON text into the tree of json_value.h.
#include <charconv>
#include <cstddef>
#include <string_view>
#include <system_error>
#include <unordered_map>

#include "json_value.h"
#include "problems.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

// Walks over a text and always knows its current line and column. Columns count characters, not bytes.
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

bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
bool in_word(char c) noexcept {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '.';
}

// Recursive descent over the text, at most json_depth_max deep. The tree of nlohmann-json knows no positions and its
// messages name grammar tokens; the tests hold this parser against that one on thousands of mutated texts.
class JsonParser {
 public:
  JsonParser(std::string_view text, const std::string& file) : at_(text), file_(file) {}

  JsonValue parse() {
    skip_space();
    if (at_.at_end()) fail("the file is empty, a JSON object is needed");
    JsonValue value = parse_value(0);
    skip_space();
    if (!at_.at_end()) fail("nothing may follow the end of the JSON text, but here stands " + here());
    return value;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { fail(at_.place(), message); }
  [[noreturn]] void fail(TextPlace place, const std::string& message) const { refuse(file_, place, message); }

  // What stands at the cursor, for messages.
  std::string here() const {
    if (at_.at_end()) return "the end of the file";
    std::string word;
    for (std::size_t i = 0; i < 20 && in_word(at_.peek(i)); ++i) word += at_.peek(i);
    if (!word.empty()) return in_quotes(word);
    const auto c = static_cast<unsigned char>(at_.peek());
    if (c == '"') return "a string";
    if (c == '\n' || c == '\r') return "the end of the line";
    if (c < 0x20U || c >= 0x7FU) return "a character that is not JSON";
    return std::string("'") + at_.peek() + "'";
  }

  void skip_space() {
    while (!at_.at_end()) {
      const char c = at_.peek();
      if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
        at_.next();
      } else if (c == '/') {
        skip_comment();
      } else {
        return;
      }
    }
  }

  void skip_comment() {
    const TextPlace start = at_.place();
    if (at_.peek(1) == '/') {
      while (!at_.at_end() && at_.peek() != '\n' && at_.peek() != '\r') at_.next();
    } else if (at_.peek(1) == '*') {
      at_.next();
      at_.next();
      while (!at_.at_end() && !(at_.peek() == '*' && at_.peek(1) == '/')) at_.next();
      if (at_.at_end()) fail(start, "this comment is never closed with */");
      at_.next();
      at_.next();
    } else {
      fail("a comment begins with // or /*");
    }
  }

  JsonValue parse_value(std::size_t depth) {
    if (depth >= json_depth_max) fail("values are nested deeper than " + std::to_string(json_depth_max) + " levels");
    if (++values_ > json_values_max) fail("the file holds more than " + std::to_string(json_values_max) + " values");
    const char c = at_.peek();
    if (c == '{') return parse_object(depth);
    if (c == '[') return parse_array(depth);
    JsonValue value{.place = at_.place()};
    if (c == '"') {
      value.kind = JsonValue::Kind::string;
      value.text = parse_string();
    } else if (c == '-' || is_digit(c)) {
      parse_number(value);
    } else {
      parse_word(value);
    }
    return value;
  }

  JsonValue parse_object(std::size_t depth) {
    JsonValue object{.kind = JsonValue::Kind::object, .place = at_.place()};
    std::unordered_map<std::string, int> lines;  // of the keys seen
    at_.next();
    skip_space();
    while (at_.peek() != '}') {
      object.members.push_back(parse_member(depth));
      const JsonMember& member = object.members.back();
      const auto [first, fresh] = lines.emplace(member.name, member.place.line);
      if (!fresh) {
        fail(member.place, "key " + in_quotes(member.name) + " stands twice in this object, first in line " +
                               std::to_string(first->second));
      }
      end_of_item('}', "object", object.place, "a key");
    }
    at_.next();
    return object;
  }

  JsonMember parse_member(std::size_t depth) {
    if (at_.at_end()) fail("the file ends inside an object, a closing } is missing");
    if (at_.peek() == '\'') fail("keys stand in double quotes");
    if (is_digit(at_.peek())) {
      fail("a key in double quotes is needed here, not " + here() + " (decimals are written with a point)");
    }
    if (at_.peek() != '"') fail("a key in double quotes is needed here, not " + here());
    JsonMember member;
    member.place = at_.place();
    member.name = parse_string();
    skip_space();
    if (at_.peek() != ':')
      fail("a colon is needed between key " + in_quotes(member.name) + " and its value, not " + here());
    at_.next();
    skip_space();
    member.value = parse_value(depth + 1);
    return member;
  }

  JsonValue parse_array(std::size_t depth) {
    JsonValue array{.kind = JsonValue::Kind::array, .place = at_.place()};
    at_.next();
    skip_space();
    while (at_.peek() != ']') {
      if (at_.at_end()) fail("the file ends inside an array, a closing ] is missing");
      array.items.push_back(parse_value(depth + 1));
      end_of_item(']', "array", array.place, "a value");
    }
    at_.next();
    return array;
  }

  // After a member or an item: a comma and another one, or the end.
  void end_of_item(char close, const std::string& what, TextPlace opened, const std::string& item) {
    skip_space();
    if (at_.peek() == close) return;
    if (at_.at_end()) {
      fail("the file ends inside the " + what + " opened in line " + std::to_string(opened.line) + ", a closing " +
           close + " is missing");
    }
    if (at_.peek() != ',') fail(std::string("a comma or ") + close + " is needed here, not " + here());
    const TextPlace comma = at_.place();
    at_.next();
    skip_space();
    if (at_.peek() == close) fail(comma, item + " must follow this comma, not " + here());
  }

  std::string parse_string() {
    const TextPlace start = at_.place();
    std::string text;
    at_.next();
    for (;;) {
      if (at_.at_end() || at_.peek() == '\n') fail(start, "this string is not closed with \" in its line");
      if (static_cast<unsigned char>(at_.peek()) < 0x20U) fail("a control character in a string, write it as \\u00XX");
      const TextPlace place = at_.place();
      const char c = at_.next();
      if (c == '"') return text;
      if (c == '\\') {
        parse_escape(place, text);
      } else {
        text += c;
      }
    }
  }

  void parse_escape(TextPlace start, std::string& text) {
    constexpr std::string_view names = "\"\\/bfnrt";
    constexpr std::string_view meanings = "\"\\/\b\f\n\r\t";
    const char c = at_.peek();
    if (const std::size_t i = names.find(c); i != std::string_view::npos && !at_.at_end()) {
      at_.next();
      text += meanings[i];
    } else if (c == 'u') {
      append_utf8(parse_code_point(start), text);
    } else {
      fail(start, "unknown escape in a string, known are \\\" \\\\ \\/ \\b \\f \\n \\r \\t and \\uXXXX");
    }
  }

  std::uint32_t parse_code_point(TextPlace start) {
    const std::uint32_t code = parse_hex4(start);
    if (code < 0xD800U || code > 0xDFFFU) return code;
    if (code <= 0xDBFFU && at_.peek() == '\\' && at_.peek(1) == 'u') {
      at_.next();
      const std::uint32_t low = parse_hex4(start);
      if (low >= 0xDC00U && low <= 0xDFFFU) return 0x10000U + ((code - 0xD800U) << 10U) + (low - 0xDC00U);
    }
    fail(start, "half of a surrogate pair, no character");
  }

  std::uint32_t parse_hex4(TextPlace start) {
    at_.next();  // the u
    std::uint32_t code = 0;
    for (int i = 0; i < 4; ++i) {
      const char c = at_.peek();
      const bool lower = c >= 'a' && c <= 'f', upper = c >= 'A' && c <= 'F';
      if (!is_digit(c) && !lower && !upper) fail(start, "\\u needs four hexadecimal digits");
      code = code * 16U + static_cast<std::uint32_t>(is_digit(c) ? c - '0' : (lower ? c - 'a' : c - 'A') + 10);
      at_.next();
    }
    return code;
  }

  void skip_digits(TextPlace start) {
    if (!is_digit(at_.peek()))
      fail(start, "this number is not complete, a digit must follow " + in_quotes(number_text()));
    while (is_digit(at_.peek())) at_.next();
  }

  std::string_view number_text() const { return at_.since(number_start_); }

  void parse_number(JsonValue& value) {
    number_start_ = at_.position();
    if (at_.peek() == '-') at_.next();
    if (at_.peek() == '0' && is_digit(at_.peek(1))) fail(value.place, "a number must not begin with 0");
    if (at_.peek() == 'I' || at_.peek() == 'i') fail(value.place, "infinity is no JSON number, leave the key out");
    skip_digits(value.place);
    if (at_.peek() == '.') {
      at_.next();
      skip_digits(value.place);
    }
    if (at_.peek() == 'e' || at_.peek() == 'E') {
      at_.next();
      if (at_.peek() == '+' || at_.peek() == '-') at_.next();
      skip_digits(value.place);
    }
    if (in_word(at_.peek())) fail("a number ends here, " + here() + " must not follow it");
    value.kind = JsonValue::Kind::number;
    value.text = number_text();
    const char* const end = value.text.data() + value.text.size();
    if (std::from_chars(value.text.data(), end, value.number).ec != std::errc{}) {
      fail(value.place, "the number " + in_quotes(value.text) + " is beyond what a double can hold");
    }
  }

  void parse_word(JsonValue& value) {
    if (at_.at_end()) fail("the file ends where a value is needed");
    if (at_.peek() == '\'') fail("strings stand in double quotes");
    if (at_.peek() == '+' || at_.peek() == '.') fail("a number begins with a digit or a minus sign");
    const std::string found = here();
    const std::size_t start = at_.position();
    while (in_word(at_.peek())) at_.next();
    const std::string_view word = at_.since(start);
    if (word == "true" || word == "false") {
      value.kind = JsonValue::Kind::boolean;
      value.boolean = word == "true";
    } else if (word == "NaN" || word == "nan" || word == "Infinity" || word == "inf") {
      fail(value.place, found + " is no JSON number, leave the key out");
    } else if (word == "True" || word == "False") {
      fail(value.place, found + " is written in lower case in JSON");
    } else if (word != "null") {
      fail(value.place, "a value is needed here, not " + found);
    }
  }

  TextCursor at_;
  const std::string& file_;
  std::size_t number_start_ = 0;
  std::size_t values_ = 0;
};

}  // namespace

const JsonMember* JsonValue::find(std::string_view name) const noexcept {
  for (const JsonMember& member : members) {
    if (member.name == name) return &member;
  }
  return nullptr;
}

JsonValue parse_json(std::string_view text, const std::string& file) {
  if (text.size() > json_size_max_bytes) refuse(file, {}, "the file is larger than 16 MB");
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  if (const std::size_t bad = find_invalid_utf8(text); bad != std::string_view::npos) {
    refuse(file, place_in(text, bad), "this byte is not UTF-8; save the file as UTF-8");
  }
  return JsonParser(text, file).parse();
}

}  // namespace kadans

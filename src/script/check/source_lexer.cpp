#include "source_lexer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace kadans {
namespace {

constexpr std::array<std::string_view, 22> keywords{
    "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
    "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while"};
constexpr std::array<std::string_view, 8> long_symbols{"...", "..", "==", "~=", "<=", ">=", "::", "//"};

bool digit(char c) noexcept { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

class Lexer {
 public:
  explicit Lexer(std::string_view text) : text_(text) {
    if (text_.starts_with('#')) skip_line();
  }

  Tokens run() {
    while (at_ < text_.size()) step();
    add(TokenKind::end, "");
    return std::move(tokens_);
  }

 private:
  char here(std::size_t ahead = 0) const noexcept { return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0'; }
  void add(SourceToken::Kind kind, std::string_view text) { tokens_.push_back({kind, std::string(text), line_}); }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
  }

  void step() {
    const char c = here();
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      line_ += c == '\n' ? 1 : 0;
      ++at_;
    } else if (text_.substr(at_).starts_with("--")) {
      at_ += 2;
      if (!long_bracket(false)) skip_line();
    } else if (starts_name(c)) {
      name();
    } else if (digit(c) || (c == '.' && digit(here(1)))) {
      number();
    } else if (c == '"' || c == '\'') {
      quoted(c);
    } else if (!long_bracket(true)) {
      symbol();
    }
  }

  void name() {
    const std::size_t start = at_;
    while (in_name(here())) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    add(is_keyword(word) ? TokenKind::keyword : TokenKind::name, word);
  }

  void number() {
    const std::size_t start = at_;
    const bool hex = here() == '0' && (here(1) == 'x' || here(1) == 'X');
    while (in_name(here()) || here() == '.' ||
           (!hex && (here() == '+' || here() == '-') && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E'))) {
      ++at_;
    }
    add(TokenKind::number, text_.substr(start, at_ - start));
  }

  void quoted(char quote) {
    const std::size_t start = ++at_;
    const int first = line_;
    while (at_ < text_.size() && here() != quote) {
      if (here() == '\\') ++at_;
      line_ += here() == '\n' ? 1 : 0;
      ++at_;
    }
    tokens_.push_back({TokenKind::text, std::string(text_.substr(start, at_ - start)), first});
    ++at_;
  }

  // [[ ... ]] and [==[ ... ]==]; false when there is none here.
  bool long_bracket(bool keep) {
    if (here() != '[') return false;
    std::size_t level = 0;
    while (here(1 + level) == '=') ++level;
    if (here(1 + level) != '[') return false;
    const std::size_t start = at_ + level + 2;
    const std::string close = "]" + std::string(level, '=') + "]";
    const std::size_t found = std::min(text_.find(close, start), text_.size());
    const std::string_view inside = text_.substr(start, found - start);
    if (keep) add(TokenKind::text, inside);
    line_ += static_cast<int>(std::count(inside.begin(), inside.end(), '\n'));
    at_ = std::min(found + close.size(), text_.size());
    return true;
  }

  void symbol() {
    for (const std::string_view longer : long_symbols) {
      if (!text_.substr(at_).starts_with(longer)) continue;
      add(TokenKind::symbol, longer);
      at_ += longer.size();
      return;
    }
    add(TokenKind::symbol, text_.substr(at_, 1));
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 1;
  Tokens tokens_;
};

// Behind a value: what goes on with it is no name, and no keyword but these.
bool begins_statement(const SourceToken& token) {
  if (token.kind == TokenKind::keyword) return token.text != "and" && token.text != "or";
  return token.kind == TokenKind::name || token.is("::");
}

bool may_end_value(const SourceToken& token) {
  if (token.kind == TokenKind::symbol || token.kind == TokenKind::keyword)
    return token.is_any({")", "}", "]", "...", "end", "nil", "true", "false"});
  return token.kind != TokenKind::end;
}

}  // namespace

bool is_keyword(std::string_view word) noexcept { return std::ranges::find(keywords, word) != keywords.end(); }

std::string_view line_of_text(std::string_view text, int line) noexcept {
  for (int i = 1; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find('\n'));
}

Tokens lex_source(std::string_view text) { return Lexer(text).run(); }

std::size_t end_of_call(const Tokens& tokens, std::size_t at) {
  if (tokens[at].kind == TokenKind::text && (at == 0 || !tokens[at - 1].is("("))) return at + 1;
  const bool bracket = at > 0 && tokens[at - 1].is("(");
  int depth = bracket ? 1 : 0;
  for (; tokens[at].kind != TokenKind::end; ++at) {
    depth += opens_bracket(tokens[at]);
    if (depth == 0) return at + 1;
  }
  return at;
}

int opens_block(const SourceToken& token) {
  return token.is_any({"function", "if", "do", "repeat"}) ? 1 : token.is_any({"end", "until"}) ? -1 : 0;
}

int opens_bracket(const SourceToken& token) {
  return token.is_any({"(", "{", "["}) ? 1 : token.is_any({")", "}", "]"}) ? -1 : 0;
}

std::size_t end_of_block(const Tokens& tokens, std::size_t at) {
  for (int depth = 0; tokens[at].kind != TokenKind::end; ++at) {
    depth += opens(tokens[at]);
    if (depth <= 0) return at;
  }
  return at;
}

std::vector<std::size_t> parts_of(const Tokens& tokens, std::size_t at) {
  std::vector<std::size_t> parts;
  int depth = 0;
  for (bool fresh = true; tokens[at].kind != TokenKind::end; ++at) {
    const int change = opens(tokens[at]);
    if (depth + change < 0) break;
    if (std::exchange(fresh, false)) parts.push_back(at);
    depth += change;
    fresh = depth == 0 && (tokens[at].is(",") || tokens[at].is(";"));
  }
  return parts;
}

std::vector<std::size_t> values_of(const Tokens& tokens, std::size_t at) {
  std::vector<std::size_t> values{at};
  int depth = 0;
  for (bool whole = false; tokens[at].kind != TokenKind::end; ++at) {  // whole: a value may end before the token
    const SourceToken& token = tokens[at];
    const int change = opens(token);
    if (depth == 0 && (change < 0 || token.is(";") || (whole && begins_statement(token)))) break;
    if (depth == 0 && token.is(",")) values.push_back(at + 1);
    depth += change;
    whole = depth == 0 && may_end_value(token);
  }
  values.push_back(at);
  return values;
}

}  // namespace kadans

#include "syntax_hint.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "foreign_words.h"
#include "source_lexer.h"

namespace kadans {
namespace {

// Signs of other languages. Lua has none of these pairs, so a pair of them is never right.
struct ForeignSign {
  std::string_view first, second;  // second "": alone
  std::string_view hint;
};
constexpr ForeignSign foreign_signs[] = {
    {"!", "=", "Lua writes ~= for 'is not'"},
    {"!", "==", "Lua writes ~= for 'is not'"},
    {"!", "", "Lua writes not"},
    {"==", "=", "Lua writes =="},
    {"<", ">", "Lua writes ~= for 'is not'"},
    {"&", "", "Lua writes and"},
    {"|", "", "Lua writes or"},
    {"?", "", "Lua has no ?: : write condition and one or other"},
    {"+", "+", "Lua has no ++: write n = n + 1"},
    {"=", ">", "Lua writes function(m) ... end"},
    {"-", ">", "Lua writes function(m) ... end, and a.b for a->b"},
    {"/", "*", "a comment begins with --"},
    {"//", "", "a comment begins with --"},
    {"*", "*", "Lua writes ^ for a power"},
    {":", "=", "Lua writes local x = ..."},
    {"@", "", "Lua knows no @"},
    {"$", "", "Lua knows no $"},
    {"`", "", "texts stand in \"...\" or '...'"},
};
constexpr std::string_view assigning[] = {"+", "-", "*", "/", "%", "^", ".."};  // += and its kin

// Words at the begin of a statement of another language; another name follows.
const ForeignWords foreign_starts[] = {
    {{"var", "let", "const", "int", "float", "double", "bool", "auto"}, "Lua writes local x = ..."},
    {{"def", "func", "fn"}, "Lua writes local function f(m) ... end"},
    {{"lambda"}, "Lua writes function(m) return ... end"},
    {{"import", "from"}, "Lua writes local name = require \"name\""},
    {{"elif", "elsif"}, "Lua writes elseif ... then"},
    {{"case"}, "Lua has no switch: write if ... elseif ... end"},
    {{"try"}, "Lua has no try: an error is raised by error(text)"},
};

constexpr std::size_t look_back_max = 500;  // tokens: a line may be as long as a file

bool may_end_entry(const SourceToken& token) {
  return token.kind == TokenKind::name || token.is_literal() || token.is_any({")", "}", "]", "end", "nil"});
}
bool may_begin_entry(const SourceToken& token) {
  return token.kind == TokenKind::name || token.is_literal() || token.is_any({"{", "[", "function", "not"});
}

// An entry of a message: what stands between the quotes behind `near`.
std::string_view near_of(std::string_view message) {
  constexpr std::string_view before = " near '";
  const std::size_t at = message.rfind(before);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = message.substr(at + before.size());
  return rest.substr(0, rest.rfind('\''));
}

class Explainer {
 public:
  Explainer(std::string_view text, int line, std::string_view message)
      : text_(text), line_(line), message_(message), near_(near_of(message)), tokens_(lex_source(text)) {
    tokens_.insert(tokens_.begin(), 2, SourceToken{TokenKind::end, "", 1});  // so that there is always one before
    tokens_.resize(tokens_.size() + 4, SourceToken{TokenKind::end, "", tokens_.back().line});
    at_ = place();
    for (std::size_t start = 0; start < text.size(); start = std::min(text.find('\n', start), text.size() - 1) + 1)
      indents_.push_back(text.substr(start, 256).find_first_not_of(" \t"));
    indents_.resize(static_cast<std::size_t>(tokens_.back().line) + 2);
  }

  SyntaxHint run() {
    using Rule = bool (Explainer::*)();
    constexpr Rule rules[] = {&Explainer::sign,      &Explainer::minus_minus, &Explainer::start,
                              &Explainer::hash,      &Explainer::key,         &Explainer::braces,
                              &Explainer::colon,     &Explainer::equals,      &Explainer::named_in_table,
                              &Explainer::list,      &Explainer::two_without, &Explainer::block,
                              &Explainer::bracket,   &Explainer::after_file,  &Explainer::comma,
                              &Explainer::statement, &Explainer::word};
    for (const Rule rule : rules) {
      if ((this->*rule)()) break;
    }
    return hint_;
  }

 private:
  bool tell_line(int line, std::string_view text) {
    hint_.line = line;
    std::snprintf(hint_.text.data(), hint_.text.size(), "%.*s", static_cast<int>(text.size()), text.data());
    return true;
  }
  bool tell(std::size_t at, std::string_view text) { return tell_line(tokens_[at].line, text); }
  bool says(std::string_view what) const { return message_.find(what) != std::string_view::npos; }
  bool last_in_line(std::size_t at) const { return tokens_[at + 1].line > tokens_[at].line || at_end(at + 1); }
  bool first_in_line(std::size_t at) const { return tokens_[at - 1].line < tokens_[at].line || at_end(at - 1); }
  bool at_end(std::size_t at) const { return tokens_[at].kind == TokenKind::end; }
  bool in_braces(std::size_t at) const {
    return tokens_[at - 1].is("{") || tokens_[at - 1].is(",") || tokens_[at - 1].is(";");
  }

  // The token where the compiler gave up.
  std::size_t place() const {
    std::size_t last = 2;
    for (std::size_t i = 2; i < tokens_.size() - 4; ++i) {
      if (tokens_[i].line > line_) break;
      last = i;
      if (tokens_[i].line < line_ || near_.empty()) continue;
      const std::string& token = tokens_[i].text;
      if (near_ == token || (tokens_[i].kind == TokenKind::text && near_.find(token) != std::string_view::npos))
        return i;
      if (tokens_[i].kind == TokenKind::symbol && token.starts_with(near_)) return i;
    }
    return near_ == "<eof>" ? last + 1 : last;
  }

  // The tokens of the line, and of the one before it that the compiler looked at last.
  template <typename Rule>
  bool each_in_line(Rule rule) {
    std::size_t first = at_;
    while (first > 2 && at_ - first < look_back_max && tokens_[first - 1].line >= tokens_[at_ - 1].line) --first;
    for (std::size_t i = first; !at_end(i) && i < at_ + look_back_max && tokens_[i].line <= tokens_[at_].line; ++i) {
      if (rule(i)) return true;
    }
    return false;
  }

  std::string path_before(std::size_t at) const {
    if (tokens_[at - 1].kind != TokenKind::name) return "n";
    std::string path = tokens_[at - 1].text;
    for (std::size_t i = at - 2; path.size() < 64 && tokens_[i].is(".") && tokens_[i - 1].kind == TokenKind::name;
         i -= 2)
      path.insert(0, tokens_[i - 1].text + ".");
    return path;
  }

  // n += 1
  bool tell_assigning(std::size_t at) {
    const std::string path = path_before(at);
    const std::string& sign = tokens_[at].text;
    return tell(at, "Lua has no " + sign + "=: write " + path + " = " + path + " " + sign + " ...");
  }

  bool sign() {
    return each_in_line([&](std::size_t i) {
      for (const std::string_view sign : assigning) {
        if (tokens_[i].is(sign) && tokens_[i + 1].is("=")) return tell_assigning(i);
      }
      for (const ForeignSign& one : foreign_signs) {
        if (tokens_[i].is(one.first) && (one.second.empty() || tokens_[i + 1].is(one.second))) return tell(i, one.hint);
      }
      return false;
    });
  }

  std::size_t indent(int line) const { return indents_[static_cast<std::size_t>(line)]; }

  bool minus_minus() {
    const SourceToken& before = tokens_[at_ - 1];
    if (before.kind != TokenKind::name ||
        line_of_text(text_, before.line).find(before.text + "--") == std::string_view::npos)
      return false;
    const std::string path = path_before(at_);
    return tell_line(before.line, "-- begins a comment, Lua has no --: write " + path + " = " + path + " - 1");
  }

  bool start() {
    return each_in_line([&](std::size_t i) {
      if (tokens_[i].kind != TokenKind::name || tokens_[i - 1].is(".") || tokens_[i - 1].is(":")) return false;
      if (tokens_[i].text == "continue" && (last_in_line(i) || tokens_[i + 1].is("end") || tokens_[i + 1].is(";")))
        return tell(i, "Lua has no continue: put the rest of the loop into an if");
      const bool goes_on = tokens_[i + 1].kind == TokenKind::name || tokens_[i + 1].kind == TokenKind::text ||
                           tokens_[i + 1].kind == TokenKind::number || tokens_[i + 1].is("{");
      if (tokens_[i + 1].line != tokens_[i].line || !goes_on) return false;
      const std::string_view hint = text_of(foreign_starts, tokens_[i].text);
      return !hint.empty() && tell(i, hint);
    });
  }

  bool hash() { return tokens_[at_].is("#") && first_in_line(at_) && tell(at_, "a comment begins with --"); }

  // after: 1, "after": 1, "after" = 1
  bool key() {
    return each_in_line([&](std::size_t i) {
      const SourceToken& token = tokens_[i];
      if ((token.kind != TokenKind::name && token.kind != TokenKind::text) || !in_braces(i)) return false;
      const bool equals = token.kind == TokenKind::text && tokens_[i + 1].is("=");
      const bool called = tokens_[i + 2].kind == TokenKind::name &&
                          (tokens_[i + 3].is("(") || tokens_[i + 3].is("{") || tokens_[i + 3].kind == TokenKind::text);
      const bool colon = tokens_[i + 1].is(":") && !called;
      return (equals || colon) && tell(i, "a table is written { " + token.text + " = value }");
    });
  }

  std::size_t open_of(std::size_t close) const {
    int depth = 0;
    for (std::size_t i = close; i > 1 && close - i < look_back_max; --i) {
      depth += tokens_[i].is(")") ? 1 : tokens_[i].is("(") ? -1 : 0;
      if (depth == 0) return i;
    }
    return 1;
  }
  bool ends_parameters(std::size_t at) const {
    if (!tokens_[at].is(")")) return false;
    std::size_t before = open_of(at) - 1;
    while (tokens_[before].kind == TokenKind::name || tokens_[before].is(".") || tokens_[before].is(":")) --before;
    return tokens_[before].is("function");
  }
  // The word of the line that wants `then` or `do` in it, or 0.
  std::size_t head_of_line(std::size_t at) const {
    for (std::size_t i = at; i > 1 && at - i < look_back_max && tokens_[i].line == tokens_[at].line; --i) {
      if (tokens_[i].is_any({"if", "elseif", "while", "for"})) return i;
      if (tokens_[i].is("then") || tokens_[i].is("do")) return 0;
    }
    return 0;
  }
  std::string head_written(std::size_t head) const {
    const bool loop = tokens_[head].is("while") || tokens_[head].is("for");
    return "Lua writes " + tokens_[head].text + " ... " + (loop ? "do" : "then") + " ... end";
  }

  bool braces() {
    return each_in_line([&](std::size_t i) {
      if (!tokens_[i].is("{"))
        return tokens_[i].is("}") && tokens_[i + 1].is("else") &&
               tell(i, "Lua has no braces around blocks: if ... then ... else ... end");
      if (ends_parameters(i - 1)) return tell(i, "Lua writes function(m) ... end, without braces");
      if (tokens_[i - 1].is("else")) return tell(i, "Lua has no braces around blocks: if ... then ... else ... end");
      const std::size_t head = last_in_line(i) && tokens_[i - 1].is(")") ? head_of_line(i) : 0;
      return head != 0 && tell(i, head_written(head) + ", without braces");
    });
  }

  // function(m):  if x:  else:
  bool colon() {
    return each_in_line([&](std::size_t i) {
      if (!tokens_[i].is(":")) return false;
      if (ends_parameters(i - 1)) return tell(i, "Lua writes function(m) ... end, without ':'");
      if (!last_in_line(i)) return false;
      if (tokens_[i - 1].is("else")) return tell(i, "Lua writes else without ':'");
      const std::size_t head = head_of_line(i);
      return head != 0 && tell(i, head_written(head) + ", without ':'");
    });
  }

  // if x = 1
  bool equals() {
    return near_ == "=" && each_in_line([&](std::size_t at) {
             if (!tokens_[at].is("=")) return false;
             for (std::size_t i = at - 1; i > 1 && at - i < look_back_max && tokens_[i].line == tokens_[at].line; --i) {
               if (tokens_[i].is_any({"if", "elseif", "while", "until", "return", "and", "or", "not"}))
                 return tell(at, "= assigns, == compares");
               if (tokens_[i].is_any({"then", "do", "else", "end", "local", "{", "}", ",", ";"})) return false;
             }
             return false;
           });
  }

  // { function enter(m) ... }
  bool named_in_table() {
    const std::size_t function = tokens_[at_].is("function") ? at_ : at_ - 1;
    if (!tokens_[function].is("function") || tokens_[function + 1].kind != TokenKind::name || !in_braces(function))
      return false;
    return tell(function, "in a table write " + tokens_[function + 1].text + " = function(m) ... end");
  }

  bool list() {
    if (!tokens_[at_].is("[") || !(tokens_[at_ - 1].is("=") || tokens_[at_ - 1].is("(") || tokens_[at_ - 1].is(",")))
      return false;
    return tell(at_, "a list is written { 1, 2, 3 }");
  }

  // move "stand", { ... }
  bool two_without() {
    if (!tokens_[at_].is(",") || tokens_[at_ - 1].kind != TokenKind::text || tokens_[at_ - 2].kind != TokenKind::name)
      return false;
    if (!tokens_[at_ - 3].is(":") && !tokens_[at_ - 3].is(".")) return false;
    return tell(at_, "only one text or table goes without brackets: write " + tokens_[at_ - 2].text + "(..., ...)");
  }

  struct Open {
    std::size_t token = 0;
    int line = 0;
  };

  // What is open where the compiler gave up. `suspect`: the first one whose end stands further left than its begin, so
  // that it closes something else.
  std::vector<Open> open_at(std::optional<Open>& suspect) const {
    std::vector<Open> open;
    std::size_t loop = 0;
    for (std::size_t i = 2; i < at_; ++i) {
      const SourceToken& token = tokens_[i];
      if (token.is("for") || token.is("while")) loop = i;
      const bool of_loop = token.is("do") && loop != 0;
      const int change = opens(token);
      if (change > 0) {
        open.push_back({i, of_loop ? tokens_[loop].line : token.line});
        if (of_loop) loop = 0;
      }
      if (change >= 0) continue;
      if (open.empty()) break;
      const Open last = open.back();
      if (opens_bracket(token) != -opens_bracket(tokens_[last.token])) break;
      open.pop_back();
      if (!suspect && first_in_line(i) && indent(token.line) < indent(last.line)) suspect = last;
    }
    return open;
  }

  // The second word of an `else if` that stands behind the token, or 0: it needs an end of its own.
  std::size_t else_if_behind(std::size_t from) const {
    for (std::size_t i = from; i < at_; ++i) {
      if (tokens_[i].is("else") && tokens_[i + 1].is("if") && tokens_[i].line == tokens_[i + 1].line) return i + 1;
    }
    return 0;
  }

  std::string shown(const Open& open) const {
    const SourceToken& token = tokens_[open.token];
    return (token.is("do") ? "loop" : "'" + token.text + "'") + std::string(" of line ") + std::to_string(open.line);
  }

  // An `end` is missing: something is still open that the next sign cannot close.
  bool block() {
    const SourceToken& here = tokens_[at_];
    std::optional<Open> suspect;
    const std::vector<Open> open = open_at(suspect);
    const bool unclosed = here.is(",") || opens_bracket(here) < 0 || at_end(at_) || says("'end' expected");
    if (open.empty() || !unclosed || opens_block(tokens_[open.back().token]) <= 0) return false;
    if (says("' expected near") && !says("'end' expected") && !at_end(at_)) return false;
    Open missing = open.back();
    if (suspect && opens_block(tokens_[suspect->token]) > 0) missing = *suspect;
    if (const std::size_t second = else_if_behind(open.back().token); second != 0)
      return tell(second, "Lua writes elseif in one word; 'else if' needs one more end");
    return tell_line(at_end(at_) ? missing.line : tokens_[at_ - 1].line, "the " + shown(missing) + " has no end");
  }

  bool bracket() {
    std::optional<Open> suspect;
    const std::vector<Open> open = open_at(suspect);
    if (!at_end(at_) || open.empty() || !suspect || opens_bracket(tokens_[suspect->token]) <= 0) return false;
    return tell_line(suspect->line, "the " + shown(*suspect) + " is not closed");
  }

  bool after_file() {
    if (!says("'<eof>' expected")) return false;
    if (tokens_[at_].is("end")) return tell(at_, "there is one end too many");
    if (opens_bracket(tokens_[at_]) < 0) return tell(at_, "there is one '" + tokens_[at_].text + "' too many");
    if (tokens_[at_].is(","))
      return tell(at_, "the file ends with what it returns: there is a bracket or an end too many before");
    return tell(at_, "return ends the file: what it uses stands above it");
  }

  // Whether an entry may begin at the token while the one before it goes on: f "text", f { }, and so on.
  bool goes_on(std::size_t at) const {
    const SourceToken& before = tokens_[at - 1];
    const bool argument = tokens_[at].is("{") || tokens_[at].kind == TokenKind::text;
    const bool callable = before.kind == TokenKind::name || before.is(")") || before.is("]") ||
                          (before.kind == TokenKind::text && tokens_[at - 2].kind == TokenKind::name);
    return (argument && callable) || tokens_[at].is("[");
  }

  bool comma() {
    if (!says("'}' expected") && !says("')' expected")) return false;
    if (near_ == "end") return tell(at_, "there is one end too many");
    if (says("')' expected") && first_in_line(at_)) return tell_line(tokens_[at_ - 1].line, "the '(' is not closed");
    for (std::size_t i = at_; !at_end(i) && tokens_[i].line == tokens_[at_].line; ++i) {
      const SourceToken& before = tokens_[i - 1];
      if (!near_.ends_with(tokens_[i].text) && tokens_[i].kind != TokenKind::text) continue;
      if (!may_end_entry(before) || !may_begin_entry(tokens_[i]) || goes_on(i)) continue;
      const std::string before_it = before.kind == TokenKind::text ? "\"" + before.text + "\"" : before.text;
      return tell_line(before.line, "a comma is missing behind " + before_it);
    }
    return false;
  }

  bool statement() {
    for (const char* word : {"local", "if", "for", "while", "return", "repeat"}) {
      if (tokens_[at_].is(word) && in_braces(at_))
        return tell(at_, "statements stand in functions, or above the table");
    }
    return false;
  }

  bool word() {
    if (says("'then' expected") || says("'do' expected")) {
      for (std::size_t i = at_; i > 1 && at_ - i < look_back_max; --i) {
        const bool braces = tokens_[i].is("{") && last_in_line(i);
        const std::size_t head = head_of_line(i);
        if (head != 0) return tell(head, head_written(head) + (braces ? ", without braces" : ""));
      }
    }
    const bool compares = tokens_[at_].is_any({"==", "~=", "<", ">", "<=", ">=", "and", "or"});
    if (says("'=' expected") && compares)
      return tell(at_, "a condition alone does nothing: return it, or ask it by if");
    if (says("function arguments expected") && tokens_[at_ - 2].is(":"))
      return tell(at_ - 1, "':' calls a method with (...), a field is read by '." + tokens_[at_ - 1].text + "'");
    if (says("unfinished string")) return tell_line(line_, "the quotes of a text close in its line");
    if (tokens_[at_ - 1].is("for") && tokens_[at_].is("(")) return tell(at_, "Lua writes for i = 1, n do ... end");
    return false;
  }

  std::string_view text_;
  int line_;
  std::string_view message_, near_;
  Tokens tokens_;
  std::size_t at_ = 0;
  std::vector<std::size_t> indents_{0};  // of each line, the first of which is 1
  SyntaxHint hint_;
};

}  // namespace

SyntaxHint syntax_hint(std::string_view text, int line, std::string_view message) {
  return Explainer(text, line, message).run();
}

}  // namespace kadans

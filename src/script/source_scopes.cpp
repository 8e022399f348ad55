#include "source_scopes.h"

#include <algorithm>

namespace kadans {
namespace {

using Kind = SourceToken::Kind;

bool same(const SourceMeaning& a, const SourceMeaning& b) { return a.role == b.role && a.path == b.path; }

// Keys of functions that are over within their tick.
bool is_at_once(const std::string& key) {
  return key == "enter" || key == "exit" || key == "during" || key == "action";
}

// Whether a value stands behind `return`.
bool begins_value(const SourceToken& token) {
  if (token.kind == Kind::end || token.is(";")) return false;
  return token.kind != Kind::keyword || token.is("function") || token.is("nil") || token.is("not") ||
         token.is("true") || token.is("false");
}

}  // namespace

SourceScopes::SourceScopes(std::vector<SourceToken> tokens) : tokens_(std::move(tokens)) {
  tokens_.resize(tokens_.size() + 4, SourceToken{Kind::end, "", tokens_.empty() ? 1 : tokens_.back().line});
}

void SourceScopes::tell(SourceListener& listener) {
  for (int i = 0; i < 20; ++i) {  // as deep as functions hand `m` and `s` on
    learnt_ = false;
    walk(nullptr);
    if (!learnt_) break;
  }
  walk(&listener);
}

void SourceScopes::walk(SourceListener* listener) {
  listener_ = listener;
  blocks_.assign(1, {});
  next_locals_.clear();
  functions_[0].returns = 0;  // the file's own
  for (std::size_t at = 0; tokens_[at].kind != Kind::end;) at = step(at);
}

std::vector<SourceFunction> SourceScopes::functions() const {
  std::vector<SourceFunction> all;
  for (const auto& [at, function] : functions_)
    all.push_back({tokens_[at].line, function.under_when, function.returns_value});
  return all;
}

void SourceScopes::open(std::size_t function, bool body) {
  blocks_.push_back({std::move(next_locals_), function, body});
  next_locals_.clear();
}

void SourceScopes::close() {
  if (blocks_.size() > 1) blocks_.pop_back();
}

// Reads what begins at the token and returns the token after it.
std::size_t SourceScopes::step(std::size_t at) {
  const SourceToken& token = tokens_[at];
  if (token.kind == Kind::name) return name_at(at);
  if (token.kind != Kind::keyword) {
    if (token.is("::")) return at + 3;
    return at + 1;
  }
  if (token.text == "goto") return at + 2;
  if (token.text == "function") return function_at(at);
  if (token.text == "local") return local_at(at);
  if (token.text == "for") return for_at(at);
  const std::size_t function = blocks_.back().function;
  if (token.text == "return") {
    ++functions_[function].returns;
    functions_[function].returns_value = functions_[function].returns_value || begins_value(tokens_[at + 1]);
  }
  if (token.text == "do" || token.text == "then" || token.text == "repeat") open(function);
  if (token.text == "until") next_locals_ = blocks_.back().locals;
  if (token.text == "else" || token.text == "elseif" || token.text == "end" || token.text == "until") close();
  if (token.text == "until") {  // its condition sees what the block declared
    blocks_.back().locals.merge(next_locals_);
    next_locals_.clear();
  }
  if (token.text == "else") open(function);
  return at + 1;
}

// function [name{.name}[:name]] (parameters)
std::size_t SourceScopes::function_at(std::size_t at) {
  const std::size_t start = at++;
  bool method = false;
  while (!tokens_[at].is("(") && tokens_[at].kind != Kind::end) {
    method = method || tokens_[at].is(":");
    ++at;
  }
  Function& function = functions_[start];
  function.returns = 0;
  if (start >= 2 && tokens_[start - 1].is("=") && is_key(start - 2)) {
    function.literal = is_at_once(tokens_[start - 2].text);
    give_key(tokens_[start - 2].text, start);
  }
  std::size_t number = 0;
  if (method) next_locals_["self"] = {};
  for (++at; !tokens_[at].is(")") && tokens_[at].kind != Kind::end; ++at) {
    if (tokens_[at].kind != Kind::name) continue;
    const auto given = function.given.find(number++);
    next_locals_[tokens_[at].text] = given == function.given.end() ? SourceMeaning{} : given->second;
  }
  open(start, true);
  return at + 1;
}

std::size_t SourceScopes::local_at(std::size_t at) {
  if (tokens_[at + 1].is("function")) {
    blocks_.back().locals[tokens_[at + 2].text] = {SourceRole::function, {}, at + 1};
    return function_at(at + 1);
  }
  std::vector<std::string> names;
  ++at;
  while (tokens_[at].kind == Kind::name) {
    names.push_back(tokens_[at].text);
    const bool more = tokens_[at + 1].is(",");
    at += more ? 2 : 1;
    if (!more) break;
  }
  const SourceMeaning meaning = names.size() == 1 && tokens_[at].is("=") ? value_at(at + 1) : SourceMeaning{};
  // The names hold from here on: what stands right of '=' is read with them, which matters to no check.
  for (const std::string& name : names) {
    bool outer = false;
    if (tokens_[at].is("=") && find(name, outer) != nullptr && meaning.role == SourceRole::none &&
        tokens_[at + 1].text == name) {
      continue;  // local x = x.y
    }
    blocks_.back().locals[name] = meaning;
  }
  return at;
}

std::size_t SourceScopes::for_at(std::size_t at) {
  std::map<std::string, SourceMeaning> names;
  for (++at; tokens_[at].kind == Kind::name || tokens_[at].is(","); ++at) {
    if (tokens_[at].kind == Kind::name) names[tokens_[at].text] = {};
  }
  while (!tokens_[at].is("do") && tokens_[at].kind != Kind::end) at = step(at);
  next_locals_ = std::move(names);
  return at;  // at `do`
}

bool SourceScopes::is_key(std::size_t at) const {
  if (tokens_[at].kind != Kind::name || !tokens_[at + 1].is("=") || at == 0) return false;
  return tokens_[at - 1].is("{") || tokens_[at - 1].is(",") || tokens_[at - 1].is(";");
}

const SourceMeaning* SourceScopes::find(const std::string& name, bool& outer) const {
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
    const auto found = block->locals.find(name);
    if (found == block->locals.end()) continue;
    outer = block->function != blocks_.back().function;
    return &found->second;
  }
  return nullptr;
}

// The fields after a name, then a method and the bracket of a call.
std::size_t SourceScopes::fields_at(std::size_t at, SourceUse& use) const {
  for (;;) {
    if (tokens_[at].is(".") && tokens_[at + 1].kind == Kind::name) {
      use.meaning.path.push_back(tokens_[at + 1].text);
      use.lines.push_back(tokens_[at + 1].line);
      at += 2;
    } else if (tokens_[at].is("[") && tokens_[at + 1].kind == Kind::text && tokens_[at + 2].is("]")) {
      use.meaning.path.push_back(tokens_[at + 1].text);
      use.lines.push_back(tokens_[at + 1].line);
      at += 3;
    } else {
      break;
    }
    ++use.written;
  }
  if (tokens_[at].is("[")) {  // a field that only the run knows
    use.meaning.path.emplace_back("*");
    use.lines.push_back(tokens_[at].line);
    ++use.written;
    use.assigned = false;
    return at;
  }
  if (tokens_[at].is(":") && tokens_[at + 1].kind == Kind::name) {
    use.method = tokens_[at + 1].text;
    at += 2;
  }
  if (tokens_[at].is("(") || tokens_[at].is("{") || tokens_[at].kind == Kind::text) {
    use.arguments = tokens_[at].is("(") ? at + 1 : at;
    return tokens_[at].is("(") ? at + 1 : at;
  }
  return at;
}

std::size_t SourceScopes::name_at(std::size_t at) {
  if (at > 0 && (tokens_[at - 1].is(".") || tokens_[at - 1].is(":"))) return at + 1;
  if (is_key(at)) {
    const SourceMeaning value = value_at(at + 2);
    if (value.role == SourceRole::function && tokens_[at + 2].kind == Kind::name) {
      give_key(tokens_[at].text, value.function);
    }
    return at + 2;
  }
  SourceUse use;
  use.name = tokens_[at].text;
  use.line = tokens_[at].line;
  const SourceMeaning* meaning = find(use.name, use.outer);
  use.known = meaning != nullptr;
  if (use.known) use.meaning = *meaning;
  use.lines.assign(use.meaning.path.size(), use.line);
  for (const Block& block : blocks_) use.guard = use.guard || functions_[block.function].guard;
  use.at_once = at_once(at);
  const std::size_t next = fields_at(at + 1, use);
  use.next = next;
  use.assigned = use.arguments == 0 && tokens_[next].is("=");
  if (use.arguments != 0 && use.meaning.role == SourceRole::function && use.written == 0) hand_on(use);
  if (listener_ != nullptr) listener_->used(use, tokens_);
  return next;
}

// The key of the function around the token that is over within its tick, when what stands here runs whenever that
// function does: a literal's mistakes count on every way through it, those of what it calls only on the straight one.
std::string SourceScopes::at_once(std::size_t at) const {
  const Block& block = blocks_.back();
  const auto found = functions_.find(block.function);
  if (found == functions_.end() || found->second.at_once.empty()) return "";
  const Function& function = found->second;
  const bool chosen = at > 0 && (tokens_[at - 1].is("and") || tokens_[at - 1].is("or"));
  const int own = at > 0 && tokens_[at - 1].is("return") ? 1 : 0;
  const bool straight = block.body && function.returns == own && !chosen;
  return function.literal || straight ? function.at_once : "";
}

// Whether a call gives the handle of a motion and nothing is asked of that at once.
bool SourceScopes::is_motion(const SourceUse& call) const {
  if (call.meaning.role != SourceRole::machine || call.meaning.path.size() != 1 || call.arguments == 0) return false;
  if (call.method != "move" && call.method != "move_through" && call.method != "set") return false;
  const SourceToken& after = tokens_[end_of_call(tokens_, call.arguments)];
  return !after.is(".") && !after.is(":") && !after.is("[") && !after.is("and") && !after.is("or");
}

// What the expression at the token stands for, as far as one name and its fields tell.
SourceMeaning SourceScopes::value_at(std::size_t at) const {
  if (tokens_[at].is("function")) return {SourceRole::function, {}, at};
  if (tokens_[at].kind != Kind::name) return {};
  if (tokens_[at].text == "require" && (tokens_[at + 1].text == "kadans" || tokens_[at + 2].text == "kadans")) {
    return {SourceRole::module, {}, 0};
  }
  if (tokens_[at].text == "require") {
    const std::size_t name = tokens_[at + 1].is("(") ? at + 2 : at + 1;
    const SourceToken& after = tokens_[name == at + 1 ? name + 1 : name + 2];
    const bool whole = !after.is(".") && !after.is("(") && !after.is(":") && !after.is("[");
    if (tokens_[name].kind == Kind::text && whole) return {SourceRole::own_module, {tokens_[name].text}, 0};
    return {};
  }
  bool outer = false;
  const SourceMeaning* meaning = find(tokens_[at].text, outer);
  if (meaning == nullptr) return {};
  SourceUse use;
  use.meaning = *meaning;
  const std::size_t next = fields_at(at + 1, use);
  if (use.meaning.role == SourceRole::module && use.meaning.path.size() == 1 && use.meaning.path[0] == "params") {
    return {SourceRole::parameters, {}, 0};
  }
  if (is_motion(use)) return {SourceRole::motion, {}, 0};
  if (use.arguments != 0 || !use.method.empty() || use.written > 4) return {};
  const SourceToken& after = tokens_[next];
  const bool whole = after.kind == Kind::name || after.is(",") || after.is(")") || after.is("}") || after.is(";") ||
                     after.kind == Kind::end ||
                     (after.kind == Kind::keyword && after.text != "and" && after.text != "or");
  return whole && (use.meaning.path.empty() || use.meaning.path.back() != "*") ? use.meaning : SourceMeaning{};
}

// A function that is written here is called: it is given what stands in the brackets, and is where its caller is.
void SourceScopes::hand_on(const SourceUse& call) {
  const SourceMeaning& callee = call.meaning;
  std::size_t at = call.arguments;
  Function& function = functions_[callee.function];
  if (call.guard && !function.guard) function.guard = learnt_ = true;
  if (!call.at_once.empty() && function.at_once.empty()) {
    function.at_once = call.at_once;
    learnt_ = true;
  }
  if (!tokens_[at - 1].is("(")) return;
  int depth = 0;
  std::size_t number = 0;
  bool first = true;
  for (; tokens_[at].kind != Kind::end; ++at) {
    const SourceToken& token = tokens_[at];
    if (depth == 0 && first) give(callee.function, number, value_at(at));
    first = false;
    for (const char* opens : {"(", "{", "[", "function", "if", "do", "repeat"}) depth += token.is(opens) ? 1 : 0;
    if (token.is(")") && depth == 0) return;
    for (const char* closes : {")", "}", "]", "end", "until"}) depth -= token.is(closes) ? 1 : 0;
    if (depth == 0 && token.is(",")) {
      ++number;
      first = true;
    }
  }
}

void SourceScopes::give_key(const std::string& key, std::size_t function) {
  const SourceMeaning machine{SourceRole::machine, {}, 0}, snapshot{SourceRole::snapshot, {}, 0};
  Function& given = functions_[function];
  const bool of_chart = !chart_lines_ || chart_lines_->contains(tokens_[function].line);
  if (key == "when") {
    give(function, 0, snapshot);
    give(function, 1, machine);
    given.under_when = of_chart;
    if (!given.guard) given.guard = learnt_ = true;
  } else if (key == "run" || is_at_once(key)) {
    give(function, 0, machine);
    give(function, 1, snapshot);
    if (key == "run" || !of_chart || !given.at_once.empty()) return;
    given.at_once = key;
    learnt_ = true;
  }
}

void SourceScopes::give(std::size_t function, std::size_t parameter, const SourceMeaning& meaning) {
  if (meaning.role == SourceRole::none || meaning.role == SourceRole::function) return;
  auto& given = functions_[function].given;
  const auto [entry, added] = given.emplace(parameter, meaning);
  if (added) learnt_ = true;
  if (!added && !same(entry->second, meaning) && entry->second.role != SourceRole::none) {
    entry->second = {};  // now this, now that: nothing is known
    learnt_ = true;
  }
}

}  // namespace kadans


#include "source_scopes.h"

#include <algorithm>

namespace kadans {
namespace {

constexpr int steps_max = 16;  // more of them: tables that hold one another

// Whether the expression before the token is over there.
bool ends_value(const SourceToken& after) {
  return after.kind == TokenKind::name || after.is(",") || after.is(")") || after.is("}") || after.is(";") ||
         after.kind == TokenKind::end ||
         (after.kind == TokenKind::keyword && after.text != "and" && after.text != "or");
}

}  // namespace

template <typename Values, typename Key>
void SourceFacts::learn(Values& values, const Key& key, const SourceMeaning& value) {
  if (value.role == SourceRole::none && phase == Phase::values) return;
  const auto [entry, added] = values.emplace(key, value);
  if (!added && (entry->second == value || entry->second.role == SourceRole::none)) return;
  if (!added) entry->second = {};  // now this, now that
  learnt = true;
}

void SourceFacts::give_field(const SourceMeaning& of, const std::string& field, const SourceMeaning& value) {
  const std::optional<SourcePlace> known = table(of);
  if (known) return learn(tables_[*known], field, value);
  if (phase == Phase::calls) give_somewhere(field);
}

void SourceFacts::give_parameter(SourcePlace function, std::size_t number, const SourceMeaning& value) {
  if (value.role == SourceRole::none) return;
  if (value.role == SourceRole::parameters && value.place.file != function.file) return;  // checked by their own file
  const bool other = value.role == SourceRole::function || value.role == SourceRole::table;  // which are not followed
  learn(functions[function].given, number, other ? SourceMeaning{} : value);
}

SourceMeaning SourceFacts::local(SourcePlace name) const {
  const auto found = locals_.find(name);
  return found == locals_.end() ? SourceMeaning{} : found->second;
}

// One step: the module's value, or the field's.
std::optional<SourceMeaning> SourceFacts::follow(const SourceMeaning& meaning) const {
  if (meaning.path.empty()) return std::nullopt;
  const SourceMeaning* value = nullptr;
  if (meaning.role == SourceRole::own_module) {
    const auto module = modules_.find(meaning.path.front());
    const auto found = module == modules_.end() ? returned_.end() : returned_.find(module->second);
    if (found != returned_.end()) value = &found->second;
  } else if (meaning.role == SourceRole::table) {
    const auto fields = tables_.find(meaning.place);
    if (fields == tables_.end()) return std::nullopt;
    const auto found = fields->second.find(meaning.path.front());
    if (found != fields->second.end()) value = &found->second;
  }
  if (value == nullptr || value->role == SourceRole::none) return std::nullopt;
  if (value->role == SourceRole::function && meaning.path.size() > 1) return std::nullopt;
  SourceMeaning next = *value;
  next.path.insert(next.path.end(), meaning.path.begin() + 1, meaning.path.end());
  return next;
}

SourceMeaning SourceFacts::resolve(const SourceMeaning& meaning, std::size_t& written) const {
  SourceMeaning at = meaning, known = meaning;
  std::size_t left = written;
  for (int i = 0; i < steps_max; ++i) {
    const std::optional<SourceMeaning> next = follow(at);
    if (!next) return known;
    const bool module = at.role == SourceRole::own_module;
    left = std::min(left, at.path.size() - 1);
    at = *next;
    // The name of a module says more than its table, until one of its fields is known.
    if (module && (at.role == SourceRole::table || at.role == SourceRole::own_module)) continue;
    known = at;
    written = left;
  }
  written = 0;
  return {};
}

SourceMeaning SourceFacts::resolve(const SourceMeaning& meaning) const {
  std::size_t ignored = 0;
  return resolve(meaning, ignored);
}

std::optional<SourcePlace> SourceFacts::table(SourceMeaning meaning) const {
  for (int i = 0; i < steps_max; ++i) {
    const std::optional<SourceMeaning> next = follow(meaning);
    if (!next) break;
    meaning = *next;
  }
  if (meaning.role != SourceRole::table || !meaning.path.empty()) return std::nullopt;
  return meaning.place;
}

bool SourceFacts::returns_value(SourcePlace function) const {
  std::set<SourcePlace> without;
  return returns_value(function, 0, without);
}

// `without`: those that were looked through and return nothing, so that each is looked through once.
bool SourceFacts::returns_value(SourcePlace function, int depth, std::set<SourcePlace>& without) const {
  if (without.contains(function)) return false;
  const auto found = functions.find(function);
  if (found == functions.end() || found->second.returns_value || depth > steps_max) return true;
  for (const SourcePlace& tail : found->second.tails) {
    if (returns_value(tail, depth + 1, without)) return true;
  }
  without.insert(function);
  return false;
}

std::vector<std::string> SourceFacts::fields_of(const std::string& module) const {
  std::vector<std::string> names;
  const std::optional<SourcePlace> known = table({SourceRole::own_module, {module}});
  const auto fields = known ? tables_.find(*known) : tables_.end();
  if (fields == tables_.end()) return names;
  for (const auto& [name, ignored] : fields->second) names.push_back(name);
  return names;
}

// `key = ` in the braces of a table.
bool SourceScopes::is_key(std::size_t at) const {
  if (!in_table() || tokens_[at].kind != TokenKind::name || !tokens_[at + 1].is("=")) return false;
  return tokens_[at - 1].is("{") || tokens_[at - 1].is(",") || tokens_[at - 1].is(";");
}

// Whether what ends before the token is assigned to: alone, or with more names behind commas.
bool SourceScopes::is_assigned(std::size_t at) const {
  if (in_table()) return false;
  while (tokens_[at].is(",") && tokens_[at + 1].kind == TokenKind::name) {
    SourceUse another;
    at = fields_at(at + 2, another);
    if (another.arguments != 0) return false;
  }
  return tokens_[at].is("=");
}

// The token that declares the name here.
const std::size_t* SourceScopes::find(const std::string& name, bool& outer) const {
  for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
    const auto found = block->locals.find(name);
    if (found == block->locals.end()) continue;
    outer = block->function != blocks_.back().function;
    return &found->second;
  }
  return nullptr;
}

// A name, or `require` of a module; returns the token after it.
std::size_t SourceScopes::start_at(std::size_t at, SourceUse& use) const {
  use.name = tokens_[at].text;
  use.line = tokens_[at].line;
  if (const std::size_t* declared = find(use.name, use.outer); declared != nullptr) {
    use.known = true;
    use.declared = *declared;
    use.meaning = facts_->local({file_, *declared});
    use.lines.assign(use.meaning.path.size(), use.line);
    return at + 1;
  }
  const std::size_t name = tokens_[at + 1].is("(") ? at + 2 : at + 1;
  const std::size_t after = name == at + 1 ? name + 1 : name + 2;
  if (use.name != "require" || tokens_[name].kind != TokenKind::text || (name == at + 2 && !tokens_[name + 1].is(")")))
    return at + 1;
  use.known = true;
  const std::string& module = tokens_[name].text;
  use.meaning =
      module == "kadans" ? SourceMeaning{SourceRole::module} : SourceMeaning{SourceRole::own_module, {module}};
  use.lines.assign(use.meaning.path.size(), use.line);
  return after;
}

// The fields after a name, then a method and the bracket of a call.
std::size_t SourceScopes::fields_at(std::size_t at, SourceUse& use) const {
  for (;;) {
    if (tokens_[at].is(".") && tokens_[at + 1].kind == TokenKind::name) {
      use.meaning.path.push_back(tokens_[at + 1].text);
      use.lines.push_back(tokens_[at + 1].line);
      at += 2;
    } else if (tokens_[at].is("[") && tokens_[at + 1].kind == TokenKind::text && tokens_[at + 2].is("]")) {
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
    return at;
  }
  if (tokens_[at].is(":") && tokens_[at + 1].kind == TokenKind::name) {
    use.method = tokens_[at + 1].text;
    at += 2;
  }
  if (tokens_[at].is("(") || tokens_[at].is("{") || tokens_[at].kind == TokenKind::text) {
    use.arguments = tokens_[at].is("(") ? at + 1 : at;
    return tokens_[at].is("(") ? at + 1 : at;
  }
  return at;
}

// Looks fields up in tables and modules. What is assigned to is the last field itself, not what it holds.
void SourceScopes::look_through(SourceUse& use) const {
  if (use.assigned && use.written == 0) {
    use.meaning = {};
    use.lines.clear();
    return;
  }
  SourceMeaning holder = use.meaning;
  std::size_t written = use.written;
  if (use.assigned) {
    holder.path.pop_back();
    --written;
  }
  SourceMeaning resolved = facts_->resolve(holder, written);
  if (resolved == holder) return;
  if (use.assigned) {
    resolved.path.push_back(use.meaning.path.back());
    ++written;
  }
  std::vector<int> lines(resolved.path.size() - written, use.line);
  lines.insert(lines.end(), use.lines.end() - static_cast<std::ptrdiff_t>(written), use.lines.end());
  use.meaning = std::move(resolved);
  use.lines = std::move(lines);
  use.written = written;
}

// The function that is called, when it is written in one of the files.
std::optional<SourcePlace> SourceScopes::callee_of(const SourceUse& call) const {
  if (call.arguments == 0) return std::nullopt;
  SourceMeaning callee = call.meaning;
  if (!call.method.empty()) callee = (callee.path.push_back(call.method), facts_->resolve(callee));
  if (callee.role != SourceRole::function || !callee.path.empty()) return std::nullopt;
  return callee.place;
}

// The function whose value is all that the expression is: `return f(x)`.
std::optional<SourcePlace> SourceScopes::tail_at(std::size_t at) const {
  if (tokens_[at].kind != TokenKind::name) return std::nullopt;
  SourceUse use;
  fields_at(start_at(at, use), use);
  look_through(use);
  if (use.arguments == 0) return std::nullopt;
  const SourceToken& after = tokens_[end_of_call(tokens_, use.arguments)];
  const bool last = after.kind == TokenKind::end || after.is(";") || after.is("end") || after.is("else") ||
                    after.is("elseif") || after.is("until");
  return last ? callee_of(use) : std::nullopt;
}

// Whether a call gives the handle of a motion and nothing is asked of that at once.
bool SourceScopes::is_motion(SourceUse call) const {
  if (call.arguments == 0) return false;
  look_through(call);
  if (call.meaning.role != SourceRole::machine || call.meaning.path.size() != 1) return false;
  if (call.method != "move" && call.method != "move_through" && call.method != "set") return false;
  const SourceToken& after = tokens_[end_of_call(tokens_, call.arguments)];
  return !after.is(".") && !after.is(":") && !after.is("[") && !after.is("and") && !after.is("or");
}

// Fields of tables and modules are not looked up: what they hold may be learnt later.
SourceMeaning SourceScopes::value_at(std::size_t at) const {
  if (tokens_[at].is("function")) return {SourceRole::function, {}, {file_, at}};
  if (tokens_[at].is("{")) return {SourceRole::table, {}, {file_, at}};
  if (tokens_[at].kind != TokenKind::name) return {};
  if (tokens_[at].text == "setmetatable" && tokens_[at + 1].is("(")) return value_at(at + 2);
  SourceUse use;
  const std::size_t next = fields_at(start_at(at, use), use);
  if (!use.known) return {};
  const SourceMeaning& meaning = use.meaning;
  if (meaning.role == SourceRole::module && meaning.path.size() == 1 &&
      (meaning.path[0] == "params" || meaning.path[0] == "args"))
    return {SourceRole::parameters, {}, {file_, meaning.path[0] == "args" ? std::size_t{1} : 0}};
  if (is_motion(use)) return {SourceRole::motion};
  if (use.arguments != 0 || !use.method.empty() || use.written > 4 || !ends_value(tokens_[next])) return {};
  return meaning.path.empty() || meaning.path.back() != "*" ? meaning : SourceMeaning{};
}

namespace {

// Keys of functions that are over within their tick.
bool is_at_once(const std::string& key) {
  return key == "enter" || key == "exit" || key == "during" || key == "action" || key == "result";
}

// Whether a value stands behind `return`.
bool begins_value(const SourceToken& token) {
  if (token.kind == TokenKind::end || token.is(";")) return false;
  return token.kind != TokenKind::keyword || token.is("function") || token.is("nil") || token.is("not") ||
         token.is("true") || token.is("false");
}

// What a name is given until it gets its value.
bool holds_nothing(const SourceToken& token) { return token.is("nil") || token.is("false"); }

}  // namespace

void learn_facts(const std::vector<SourceScopes*>& files, SourceFacts& facts) {
  using Phase = SourceFacts::Phase;
  for (const Phase phase : {Phase::values, Phase::unknown, Phase::calls}) {
    facts.phase = phase;
    for (int i = 0; i < 20; ++i) {  // as deep as functions hand `m` and `s` on
      facts.learnt = false;
      for (SourceScopes* const file : files) file->read();
      if (!facts.learnt) break;
    }
  }
}

SourceScopes::SourceScopes(Tokens tokens, std::size_t file, SourceFacts& facts)
    : tokens_(std::move(tokens)), file_(file), facts_(&facts) {
  tokens_.resize(tokens_.size() + 4, SourceToken{TokenKind::end, "", tokens_.empty() ? 1 : tokens_.back().line});
  for (const SourceToken& token : tokens_) {
    if (token.is("function")) ++functions_by_line_[token.line];
  }
}

void SourceScopes::walk(const SourceListener& listener) {
  listener_ = listener;
  blocks_.assign(1, {});
  braces_.clear();
  next_locals_.clear();
  function(0).returns = 0;  // the file's own
  function(0).line = tokens_[0].line;
  for (std::size_t at = 0; tokens_[at].kind != TokenKind::end;) at = step(at);
  listener_ = {};  // it refers to who listens
}

std::vector<SourceFunction> SourceScopes::functions() const {
  std::vector<SourceFunction> all;
  for (auto one = facts_->functions.lower_bound({file_, 0}); one != facts_->functions.end(); ++one) {
    if (one->first.file != file_) break;
    all.push_back({one->second.line, one->second.under_when, facts_->returns_value(one->first)});
  }
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
  if (token.kind == TokenKind::name) return name_at(at);
  if (token.kind != TokenKind::keyword) {
    symbol_at(at);
    return token.is("::") ? at + 3 : at + 1;
  }
  if (token.text == "goto") return at + 2;
  if (token.text == "function") return function_at(at);
  if (token.text == "local") return local_at(at);
  if (token.text == "for") return for_at(at);
  if (token.text == "return") return_at(at);
  const std::size_t function = blocks_.back().function;
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

// Braces, and ["key"] = in them or behind a value that has no name.
void SourceScopes::symbol_at(std::size_t at) {
  if (tokens_[at].is("{")) braces_.push_back({at, blocks_.size()});
  if (tokens_[at].is("}") && !braces_.empty()) braces_.pop_back();
  if (!tokens_[at].is("[") || tokens_[at + 1].kind != TokenKind::text || !tokens_[at + 2].is("]")) return;
  if (!tokens_[at + 3].is("=")) return;
  const std::string& key = tokens_[at + 1].text;
  if (in_table()) {
    facts_->give_field({SourceRole::table, {}, {file_, braces_.back().token}}, key, value_at(at + 4));
  } else {
    facts_->give_somewhere(key);
  }
}

void SourceScopes::return_at(std::size_t at) {
  const std::size_t token = blocks_.back().function;
  ++function(token).returns;
  if (!begins_value(tokens_[at + 1])) return;
  if (token == 0) facts_->give_module(file_, value_at(at + 1));
  if (facts_->phase != SourceFacts::Phase::calls) return;
  const std::optional<SourcePlace> tail = tail_at(at + 1);
  if (tail) {
    function(token).tails.insert(*tail);
  } else {
    function(token).returns_value = true;
  }
}

// function [name{.name}[:name]] (parameters)
std::size_t SourceScopes::function_at(std::size_t start) {
  Function& function = this->function(start);
  function.line = tokens_[start].line;
  function.returns = 0;
  function.in_chart = !chart_ || chart_->contains(function.line);
  call_by_chart(start);
  if (start >= 2 && tokens_[start - 1].is("=") && is_key(start - 2)) {
    function.literal = function.in_chart && is_at_once(tokens_[start - 2].text);
    give_key(tokens_[start - 2].text, {file_, start});
  }
  const SourceMeaning holder = name_function(start);
  std::size_t at = start + 1;
  while (!tokens_[at].is("(") && tokens_[at].kind != TokenKind::end) ++at;
  const auto declare = [&](std::size_t number, const std::string& name, std::size_t token,
                           const SourceMeaning& otherwise) {
    const auto given = function.given.find(number);
    facts_->give_local({file_, token}, given == function.given.end() ? otherwise : given->second);
    next_locals_[name] = token;
  };
  std::size_t number = 0;
  if (at > start + 3 && tokens_[at - 2].is(":")) declare(number++, "self", start, holder);
  for (++at; !tokens_[at].is(")") && tokens_[at].kind != TokenKind::end; ++at) {
    if (tokens_[at].kind == TokenKind::name) declare(number++, tokens_[at].text, at, {});
  }
  open(start, true);
  return at + 1;
}

// Gives the function to its name: a local that was declared before, or a field. Returns what the field is of.
SourceMeaning SourceScopes::name_function(std::size_t start) {
  if (tokens_[start + 1].kind != TokenKind::name) return {};
  std::vector<std::string> names;
  for (std::size_t at = start + 1; tokens_[at].kind == TokenKind::name; at += 2) {
    names.push_back(tokens_[at].text);
    if (!tokens_[at + 1].is(".") && !tokens_[at + 1].is(":")) break;
  }
  const SourceMeaning value{SourceRole::function, {}, {file_, start}};
  bool outer = false;
  const std::size_t* declared = find(names.front(), outer);
  if (names.size() == 1) {
    if (declared != nullptr) facts_->give_local({file_, *declared}, value);
    return {};
  }
  SourceMeaning holder = declared == nullptr ? SourceMeaning{} : facts_->local({file_, *declared});
  if (holder.role != SourceRole::none) holder.path.insert(holder.path.end(), names.begin() + 1, names.end() - 1);
  facts_->give_field(holder, names.back(), value);
  return holder;
}

// A function of the chart, however it came there, is known by its line. Where several begin there, its key is not, and
// its state is when they all have one.
void SourceScopes::call_by_chart(std::size_t start) {
  const int line = tokens_[start].line;
  if (!chart_ || !chart_->contains(line)) return;
  const auto& [keys, states] = chart_->at(line);
  const bool alone = functions_by_line_[line] == 1;
  for (const std::string& key : keys) {
    if (alone) give_key(key, {file_, start});
  }
  if (alone || states.size() == 1) function(start).states.insert(states.begin(), states.end());
}

std::size_t SourceScopes::local_at(std::size_t at) {
  if (tokens_[at + 1].is("function")) {
    blocks_.back().locals[tokens_[at + 2].text] = at + 2;
    return function_at(at + 1);
  }
  std::vector<std::size_t> names;
  ++at;
  while (tokens_[at].kind == TokenKind::name) {
    names.push_back(at);
    const bool more = tokens_[at + 1].is(",");
    at += more ? 2 : 1;
    if (!more) break;
  }
  if (tokens_[at].is("=")) {
    const std::vector<std::size_t> values = values_of(tokens_, at + 1);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool own = i + 1 < values.size();  // else of the last value, a call
      if (!own || !holds_nothing(tokens_[values[i]]))
        facts_->give_local({file_, names[i]}, own ? value_at(values[i]) : SourceMeaning{});
    }
    while (at < values.back()) at = step(at);
  }
  for (const std::size_t name : names) blocks_.back().locals[tokens_[name].text] = name;  // they hold from here on
  return at;
}

std::size_t SourceScopes::for_at(std::size_t at) {
  std::map<std::string, std::size_t> names;
  for (++at; tokens_[at].kind == TokenKind::name || tokens_[at].is(","); ++at) {
    if (tokens_[at].kind == TokenKind::name) names[tokens_[at].text] = at;
  }
  while (!tokens_[at].is("do") && tokens_[at].kind != TokenKind::end) at = step(at);
  next_locals_ = std::move(names);
  return at;  // at `do`
}

// key = value
std::size_t SourceScopes::key_at(std::size_t at) {
  const std::string& key = tokens_[at].text;
  const SourceMeaning value = value_at(at + 2);
  if (!holds_nothing(tokens_[at + 2]))
    facts_->give_field({SourceRole::table, {}, {file_, braces_.back().token}}, key, value);
  const SourceMeaning function = facts_->resolve(value);
  if (function.role == SourceRole::function && tokens_[at + 2].kind == TokenKind::name) give_key(key, function.place);
  return at + 2;
}

std::size_t SourceScopes::name_at(std::size_t at) {
  if (at > 0 && (tokens_[at - 1].is(".") || tokens_[at - 1].is(":"))) {  // of a value that has no name
    if (tokens_[at + 1].is("=") || tokens_[at + 1].is(",")) facts_->give_somewhere(tokens_[at].text);
    return at + 1;
  }
  if (is_key(at)) return key_at(at);
  SourceUse use;
  use.at = at;
  const std::size_t fields = start_at(at, use);
  for (const Block& block : blocks_) use.guard = use.guard || function(block.function).guard;
  use.at_once = at_once(at);
  use.states = function(blocks_.back().function).states;
  use.next = fields_at(fields, use);
  use.assigned = use.arguments == 0 && is_assigned(use.next);
  if (use.assigned && use.known) assign(use, at);
  look_through(use);
  if (const std::optional<SourcePlace> callee = callee_of(use)) hand_on(use, *callee);
  if (listener_) listener_(use, tokens_);
  return use.next;
}

// name{.name} = value, alone or with others.
void SourceScopes::assign(const SourceUse& use, std::size_t at) {
  const bool alone = tokens_[use.next].is("=") && !(at > 0 && tokens_[at - 1].is(","));
  const SourceMeaning value = alone ? value_at(use.next + 1) : SourceMeaning{};
  const bool nothing = alone && holds_nothing(tokens_[use.next + 1]);
  if (use.written == 0) {
    bool outer = false;
    if (!nothing) facts_->give_local({file_, *find(use.name, outer)}, value);
    return;
  }
  const std::string& field = use.meaning.path.back();
  SourceMeaning holder = use.meaning;
  holder.path.pop_back();
  if (nothing) {
    facts_->give_somewhere(field);
  } else {
    facts_->give_field(holder, field, value);
  }
}

// The key of the function around the token that is over within its tick, when what stands here runs whenever that
// function does: a literal's mistakes count on every way through it, those of what it calls only on the straight one.
std::string SourceScopes::at_once(std::size_t at) const {
  const Block& block = blocks_.back();
  const auto found = facts_->functions.find({file_, block.function});
  if (found == facts_->functions.end() || found->second.at_once.empty()) return "";
  const Function& function = found->second;
  const bool chosen = at > 0 && (tokens_[at - 1].is("and") || tokens_[at - 1].is("or"));
  const int own = at > 0 && tokens_[at - 1].is("return") ? 1 : 0;
  const bool straight = block.body && function.returns == own && !chosen;
  return function.literal || straight ? function.at_once : "";
}

// A function that is written in one of the files is called: it is given what stands in the brackets, and is where its
// caller is.
void SourceScopes::hand_on(const SourceUse& call, SourcePlace callee) {
  Function& function = facts_->functions[callee];
  if (facts_->phase == SourceFacts::Phase::calls) {
    const bool guard = call.guard && !function.guard, at_once = !call.at_once.empty() && function.at_once.empty();
    if (guard) function.guard = true;
    if (at_once) function.at_once = call.at_once;
    const std::size_t states = function.states.size();
    function.states.insert(call.states.begin(), call.states.end());
    facts_->learnt = facts_->learnt || guard || at_once || function.states.size() > states;
  }
  std::size_t number = call.method.empty() ? 0 : 1;
  if (!tokens_[call.arguments - 1].is("(")) return;
  for (const std::size_t argument : parts_of(tokens_, call.arguments))
    facts_->give_parameter(callee, number++, value_at(argument));
}

void SourceScopes::give_key(const std::string& key, SourcePlace place) {
  const SourceMeaning machine{SourceRole::machine}, snapshot{SourceRole::snapshot};
  const bool when = key == "when", at_once = is_at_once(key);
  Function& function = facts_->functions[place];
  if (!function.in_chart || (!when && !at_once && key != "run")) return;
  facts_->give_parameter(place, when ? 1 : 0, machine);
  facts_->give_parameter(place, when ? 0 : 1, snapshot);
  if (facts_->phase != SourceFacts::Phase::calls) return;
  if (when) {
    facts_->learnt = facts_->learnt || !function.guard;
    function.under_when = function.guard = true;
  } else if (at_once && function.at_once.empty()) {
    function.at_once = key;
    facts_->learnt = true;
  }
}

}  // namespace kadans

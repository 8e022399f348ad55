#include "source_facts.h"

#include <algorithm>

#include "source_scopes.h"

namespace kadans {
namespace {

constexpr int steps_max = 16;  // more of them: tables that hold one another

using Kind = SourceToken::Kind;

// Whether the expression before the token is over there.
bool ends_value(const SourceToken& after) {
  return after.kind == Kind::name || after.is(",") || after.is(")") || after.is("}") || after.is(";") ||
         after.kind == Kind::end || (after.kind == Kind::keyword && after.text != "and" && after.text != "or");
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
  if (!in_table() || tokens_[at].kind != Kind::name || !tokens_[at + 1].is("=")) return false;
  return tokens_[at - 1].is("{") || tokens_[at - 1].is(",") || tokens_[at - 1].is(";");
}

// Whether what ends before the token is assigned to: alone, or with more names behind commas.
bool SourceScopes::is_assigned(std::size_t at) const {
  if (in_table()) return false;
  while (tokens_[at].is(",") && tokens_[at + 1].kind == Kind::name) {
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
    use.meaning = facts_->local({file_, *declared});
    use.lines.assign(use.meaning.path.size(), use.line);
    return at + 1;
  }
  const std::size_t name = tokens_[at + 1].is("(") ? at + 2 : at + 1;
  const std::size_t after = name == at + 1 ? name + 1 : name + 2;
  if (use.name != "require" || tokens_[name].kind != Kind::text || (name == at + 2 && !tokens_[name + 1].is(")")))
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
  if (tokens_[at].kind != Kind::name) return std::nullopt;
  SourceUse use;
  fields_at(start_at(at, use), use);
  look_through(use);
  if (use.arguments == 0) return std::nullopt;
  const SourceToken& after = tokens_[end_of_call(tokens_, use.arguments)];
  const bool last = after.kind == Kind::end || after.is(";") || after.is("end") || after.is("else") ||
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
  if (tokens_[at].kind != Kind::name) return {};
  if (tokens_[at].text == "setmetatable" && tokens_[at + 1].is("(")) return value_at(at + 2);
  SourceUse use;
  const std::size_t next = fields_at(start_at(at, use), use);
  if (!use.known) return {};
  const SourceMeaning& meaning = use.meaning;
  if (meaning.role == SourceRole::module && meaning.path.size() == 1 && meaning.path[0] == "params")
    return {SourceRole::parameters, {}, {file_, 0}};
  if (is_motion(use)) return {SourceRole::motion};
  if (use.arguments != 0 || !use.method.empty() || use.written > 4 || !ends_value(tokens_[next])) return {};
  return meaning.path.empty() || meaning.path.back() != "*" ? meaning : SourceMeaning{};
}

}  // namespace kadans

#include "source_facts.h"

#include <algorithm>

namespace kadans {
namespace {

constexpr int steps_max = 16;  // more of them: tables that hold one another

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

}  // namespace kadans

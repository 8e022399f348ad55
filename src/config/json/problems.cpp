#include "problems.h"

#include <algorithm>
#include <tuple>

#include "kadans/signal/nearest_name.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t problems_max = 100;  // of one file; nobody reads more, and hostile input may make millions
constexpr std::size_t names_shown_max = 10;
constexpr std::size_t name_length_max = 80;

std::string first_names(std::span<const std::string> known) {
  if (known.empty()) return " (none is known)";
  const std::size_t shown = std::min(known.size(), names_shown_max);
  return " (known: " + listed(known.first(shown)) + (shown < known.size() ? ", ...)" : ")");
}

// "rotor_inertia" for rotor_inertia_kg_m2: the commonest mistake is too far away for an edit distance.
std::string without_unit(std::string_view wrong, std::span<const std::string> known) {
  for (const std::string& name : known) {
    if (!wrong.empty() && name.starts_with(std::string(wrong) + "_")) return ", did you mean '" + name + "'?";
  }
  return "";
}

}  // namespace

std::string in_quotes(std::string_view name) {
  std::size_t end = std::min(name.size(), name_length_max);
  while (end < name.size() && end > 0 && inside_character(name[end])) --end;  // half a character shows nothing
  std::string text = shown_text(name.substr(0, end));
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\t'; }, '?');
  return "'" + text + (end < name.size() ? "...'" : "'");
}

std::string unknown_name(std::string_view what, std::string_view wrong, std::span<const std::string> known,
                         std::string_view where) {
  std::string text = "unknown " + std::string(what) + " " + in_quotes(wrong);
  if (!where.empty()) text += " " + std::string(where);
  std::string hint = did_you_mean(wrong, known);
  if (hint.empty()) hint = without_unit(wrong, known);
  return text + (hint.empty() ? first_names(known) : hint);
}

void Problems::add(TextPlace place, std::string message) {
  if (problems_.size() < problems_max) problems_.push_back({file_, place.line, place.column, std::move(message)});
}

void Problems::add(const InputError& error) {
  others_.insert(others_.end(), error.problems().begin(), error.problems().end());
}

void Problems::add_unknown(TextPlace place, std::string_view what, std::string_view wrong,
                           std::span<const std::string> known, std::string_view where) {
  if (problems_.size() < problems_max) add(place, unknown_name(what, wrong, known, where));
}

std::optional<std::size_t> Problems::known(const PlacedName& name, std::string_view what,
                                           std::span<const std::string> known, std::string_view where) {
  const auto found = std::ranges::find(known, name.name);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  add_unknown(name.place, what, name.name, known, where);
  return std::nullopt;
}

void Problems::throw_if_any() const {
  if (empty()) return;
  const auto order = [](const InputProblem& p) { return std::tie(p.line, p.column, p.message); };
  std::vector<InputProblem> all = problems_;
  std::stable_sort(all.begin(), all.end(), [&](const auto& a, const auto& b) { return order(a) < order(b); });
  const auto same = [&](const auto& a, const auto& b) { return order(a) == order(b); };
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  all.insert(all.end(), others_.begin(), others_.end());
  throw InputError(std::move(all));
}

void refuse(const std::string& file, TextPlace place, const std::string& message) {
  throw InputError(InputProblem{file, place.line, place.column, message});
}

void refuse_unknown(const std::string& file, const PlacedName& wrong, std::string_view what,
                    std::span<const std::string> known) {
  refuse(file, wrong.place, unknown_name(what, wrong.name, known));
}

}  // namespace kadans

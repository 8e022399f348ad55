#include "checks.h"

#include <algorithm>
#include <cmath>

namespace kadans {

Checks::Checks(const SignalTable& signals, const std::vector<ScenarioCheck>& checks, const std::string& file)
    : conditions_(signals) {
  Problems problems(file);
  for (const ScenarioCheck& check : checks) {
    Judged judged{.check = Check(check)};
    if (!check.that.empty()) {
      judged.that = compile(check.that, check.that_place, problems);
    } else if (const auto signal = signals.find(check.signal)) {
      judged.signal = *signal;
    } else {
      problems.add_unknown(check.signal_place, "signal", check.signal, signals.names());
    }
    if (!check.when.empty()) judged.when = compile(check.when, check.when_place, problems);
    judged_.push_back(std::move(judged));
  }
  problems.throw_if_any();
}

// The column in the file: the text begins behind its quote. Escapes before it would move it; conditions have none.
std::size_t Checks::compile(const std::string& text, TextPlace place, Problems& problems) {
  std::size_t index = none;
  ExpressionError error;
  if (!conditions_.add(text, index, error)) {
    if (place.column > 0) place.column += error.column;
    problems.add(place, error.message);
  }
  return index;
}

// How far the value is outside the bounds. NaN is infinitely far outside.
Check::Observation Checks::observe(const Judged& judged, std::span<const double> row) const {
  const ScenarioCheck& check = judged.check.config();
  const bool when = judged.when == none || conditions_.holds(judged.when);
  if (judged.that == none) {
    const double value = row[judged.signal];
    const double excess =
        std::isnan(value) ? std::numeric_limits<double>::infinity() : std::max(check.min - value, value - check.max);
    return {value, excess, when};
  }
  const auto signals = conditions_.signals_of(judged.that);
  return {signals.empty() ? 0 : row[signals.front()], conditions_.holds(judged.that) ? -1.0 : 1.0, when};
}

void Checks::update(double time_s, std::span<const double> row) noexcept {
  if (broken_) return;
  broken_ = conditions_.size() > 0 && !conditions_.evaluate(time_s, row);
  if (broken_) return;
  for (Judged& judged : judged_) judged.check.update(time_s, observe(judged, row));
}

std::vector<CheckResult> Checks::results() const {
  std::vector<CheckResult> results;
  for (const Judged& judged : judged_) {
    results.push_back(judged.check.result());
    if (!broken_) continue;
    results.back().passed = false;
    results.back().note = "not judged: " + conditions_.error();
  }
  return results;
}

std::vector<SignalId> Checks::signals_of(std::size_t index) const {
  const Judged& judged = judged_.at(index);
  std::vector<SignalId> signals;
  if (judged.that == none) signals.push_back(judged.signal);
  for (const std::size_t condition : {judged.that, judged.when}) {
    if (condition == none) continue;
    for (const SignalId signal : conditions_.signals_of(condition)) {
      if (std::ranges::find(signals, signal) == signals.end()) signals.push_back(signal);
    }
  }
  return signals;
}

}  // namespace kadans

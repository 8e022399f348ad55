#include "checks.h"

#include <algorithm>
#include <cmath>

#include "signal/number_text.h"

namespace kadans {
namespace {

std::string bounds_text(const ScenarioCheck& check) {
  if (!check.that.empty()) return check.that;
  if (std::isfinite(check.min) && std::isfinite(check.max)) return printed("%g .. %g", check.min, check.max);
  return std::isfinite(check.min) ? printed(">= %g", check.min) : printed("<= %g", check.max);
}

std::string wanted_text(const ScenarioCheck& check) {
  const std::string bounds = bounds_text(check);
  switch (check.kind) {
    case CheckKind::always:
      return bounds;
    case CheckKind::never:
      return "never " + bounds;
    case CheckKind::eventually:
      return "at least once " + bounds;
    case CheckKind::at_end:
      return "at the end " + bounds;
    case CheckKind::within:
      return bounds + printed(" within %g s of ", check.within_s) + check.when;
    case CheckKind::settles:
      return bounds + printed(" for good within %g s", check.within_s) +
             (check.when.empty() ? "" : " of " + check.when);
  }
  return bounds;
}

}  // namespace

Checks::Checks(const SignalTable& signals, const std::vector<ScenarioCheck>& checks, const std::string& file,
               std::span<const SignalState> states)
    : conditions_(signals, states) {
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

// The column in the file: the text begins behind its quote.
std::size_t Checks::compile(const std::string& text, TextPlace place, Problems& problems) {
  std::size_t index = none;
  ExpressionError error;
  if (!conditions_.add(text, index, error)) {
    if (place.column > 0) place.column += error.file_column(text);
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
  const std::size_t failed = conditions_.failed();
  const auto of_failed = [&](const Judged& judged) { return judged.that == failed || judged.when == failed; };
  const auto cause = std::ranges::find_if(judged_, of_failed);
  for (const Judged& judged : judged_) {
    results.push_back(judged.check.result());
    if (!broken_) continue;
    results.back().passed = false;
    results.back().note = "not judged: ";
    if (cause == judged_.end() || of_failed(judged))
      results.back().note += conditions_.error();
    else
      results.back().note += "check '" + cause->check.config().name + "' stopped all";
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

void Check::update(double time_s, const Observation& seen) noexcept {
  if (!(time_s >= check_.from_s && time_s <= check_.until_s)) return;
  last_s_ = time_s;
  switch (check_.kind) {
    case CheckKind::always:
      return keep_worst(time_s, seen, seen.excess);
    case CheckKind::never:
    case CheckKind::eventually:
      return keep_worst(time_s, seen, -seen.excess);  // what is deepest inside
    case CheckKind::at_end:
      return keep_worst(time_s, seen, std::numeric_limits<double>::infinity());  // the last
    case CheckKind::within:
      return update_within(time_s, seen);
    case CheckKind::settles:
      return update_settling(time_s, seen);
  }
}

void Check::keep_worst(double time_s, const Observation& seen, double badness) noexcept {
  if (!seen_ || badness > worst_ || check_.kind == CheckKind::at_end) {
    worst_ = badness;
    value_ = seen.value;
    excess_ = seen.excess;
    at_s_ = time_s;
  }
  seen_ = true;
}

void Check::update_within(double time_s, const Observation& seen) noexcept {
  if (seen.when && !when_ && !waiting_) {
    started_ = waiting_ = true;
    began_s_ = time_s;
  }
  when_ = seen.when;
  if (failed_ || !waiting_) return;
  value_ = seen.value;
  at_s_ = time_s;
  failed_ = time_s - began_s_ > check_.within_s;
  if (seen.excess > 0) return;
  waiting_ = false;
  met_ = true;
}

void Check::update_settling(double time_s, const Observation& seen) noexcept {
  if (!started_ && seen.when) {
    started_ = true;
    began_s_ = time_s;
  }
  if (!started_ || seen.excess <= 0) return;
  outside_s_ = time_s;
  at_s_ = time_s;
}

bool Check::lost() const noexcept {
  switch (check_.kind) {
    case CheckKind::always:
      return seen_ && !(excess_ <= 0);
    case CheckKind::never:
      return seen_ && excess_ <= 0;
    case CheckKind::within:
      return failed_;
    case CheckKind::settles:
      return started_ && outside_s_ - began_s_ > check_.within_s;
    case CheckKind::eventually:
    case CheckKind::at_end:
      return false;
  }
  return false;
}

CheckResult Check::settled() const {
  CheckResult result{
      .name = check_.name, .value = std::max(0.0, outside_s_ - began_s_), .at_s = at_s_, .wanted = wanted_text(check_)};
  if (last_s_ - began_s_ < check_.within_s) {
    result.note = "the run ended before within_s had passed";
  } else {
    result.passed = result.value <= check_.within_s;
  }
  return result;
}

CheckResult Check::result() const {
  CheckResult result{.name = check_.name, .value = value_, .at_s = at_s_, .wanted = wanted_text(check_)};
  if (check_.kind == CheckKind::within || check_.kind == CheckKind::settles) {
    if (!started_) {
      result.note = "its `when` never became true";
      return result;
    }
    if (check_.kind == CheckKind::settles) return settled();
    result.passed = !failed_ && met_;
    if (!failed_ && !met_) result.note = "the run ended before within_s had passed";
    return result;
  }
  if (!seen_) {
    result.note = "never looked at";
    return result;
  }
  const bool holds = excess_ <= 0;
  result.passed = check_.kind == CheckKind::never ? !holds : holds;
  return result;
}

}  // namespace kadans

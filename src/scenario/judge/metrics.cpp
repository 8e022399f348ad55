
#include "metrics.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Metrics::Metrics(const SignalTable& signals, const std::vector<MetricConfig>& metrics, const std::string& file,
                 std::span<const SignalState> states)
    : conditions_(signals, states) {
  Problems problems(file);
  for (const MetricConfig& config : metrics) {
    Gathered metric{.config = config};
    if (config.signal.empty()) {
      using Gives = SignalExpressions::Gives;
      const bool number = !config.value.empty();
      const std::string& text = number ? config.value : config.that;
      const TextPlace start = number ? config.value_place : config.that_place;
      ExpressionError error;
      if (!conditions_.add(text, metric.index, error, number ? Gives::number : Gives::condition)) {
        problems.add({start.line, start.column > 0 ? start.column + error.file_column(text) : 0}, error.message);
      }
    } else if (const auto signal = signals.find(config.signal)) {
      metric.index = *signal;
    } else {
      problems.add_unknown(config.signal_place, "signal", config.signal, signals.names());
    }
    metrics_.push_back(std::move(metric));
  }
  problems.throw_if_any();
}

void Metrics::tick(double time_s, std::span<const double> row) {
  if (conditions_.size() > 0 && !broken_) broken_ = !conditions_.evaluate(time_s, row);
  for (Gathered& metric : metrics_) {
    if (!(time_s >= metric.config.from_s && time_s <= metric.config.until_s)) continue;
    const bool computed = metric.config.signal.empty();
    if (computed && broken_) continue;
    add(metric, time_s, computed ? conditions_.value(metric.index) : row[metric.index]);
  }
}

void Metrics::add(Gathered& metric, double time_s, double value) const noexcept {
  const bool first = metric.ticks++ == 0;
  double& kept = metric.value;
  switch (metric.config.kind) {
    case MetricKind::max:
      kept = first || value > kept || std::isnan(value) ? value : kept;
      break;
    case MetricKind::min:
      kept = first || value < kept || std::isnan(value) ? value : kept;
      break;
    case MetricKind::mean:
    case MetricKind::share:
      kept += value;
      break;
    case MetricKind::rms:
      kept += value * value;
      break;
    case MetricKind::end:
      kept = value;
      break;
    case MetricKind::first_time:
      kept = first ? nothing : kept;
      if (std::isnan(kept) && value != 0) kept = time_s;
      break;
    case MetricKind::since:
      if (first || value == 0) kept = nothing;
      if (std::isnan(kept) && value != 0) kept = time_s;
      break;
  }
}

std::vector<MetricValue> Metrics::values() const {
  std::vector<MetricValue> values;
  for (const Gathered& metric : metrics_) {
    const MetricKind kind = metric.config.kind;
    double value = metric.value;
    const auto ticks = static_cast<double>(metric.ticks);
    if (kind == MetricKind::mean || kind == MetricKind::share) value /= ticks;
    if (kind == MetricKind::rms) value = std::sqrt(value / ticks);
    if (metric.ticks == 0 || (broken_ && metric.config.signal.empty())) value = nothing;
    values.push_back({metric.config.name, value});
  }
  return values;
}

namespace {

constexpr double around_s = 1;
constexpr std::size_t signals_max = 3;

}  // namespace

Evidence::Evidence(const Checks& checks, const SignalTable& signals) : checks_(checks), signals_(signals) {
  for (std::size_t i = 0; i < checks.size(); ++i) {
    for (const SignalId signal : checks.signals_of(i)) {
      if (std::ranges::find(kept_, signal) == kept_.end()) kept_.push_back(signal);
    }
  }
}

std::size_t Evidence::column(SignalId signal) const {
  return static_cast<std::size_t>(std::ranges::find(kept_, signal) - kept_.begin());
}

void Evidence::tick(double time_s, std::span<const double> row) {
  if (time_s < next_s_) return;
  next_s_ += period_s;
  for (const SignalId signal : kept_) values_.push_back(static_cast<float>(row[signal]));
}

std::vector<EvidenceTrace> Evidence::around(const std::vector<CheckResult>& results) const {
  std::vector<EvidenceTrace> traces;
  if (kept_.empty()) return traces;
  const auto rows = static_cast<std::ptrdiff_t>(values_.size() / kept_.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].passed) continue;
    const std::ptrdiff_t first =
        std::clamp<std::ptrdiff_t>(std::lround((results[i].at_s - around_s) / period_s), 0, rows);
    const std::ptrdiff_t last =
        std::clamp<std::ptrdiff_t>(std::lround((results[i].at_s + around_s) / period_s), first, rows);
    const std::vector<SignalId> signals = checks_.signals_of(i);
    for (std::size_t s = 0; s < std::min(signals.size(), signals_max); ++s) {
      EvidenceTrace trace{.check = results[i].name,
                          .signal = signals_.info(signals[s]).name,
                          .unit = signals_.info(signals[s]).unit,
                          .from_s = static_cast<double>(first) * period_s,
                          .to_s = static_cast<double>(last) * period_s};
      for (std::ptrdiff_t r = first; r < last; ++r) {
        trace.values.push_back(double{values_[static_cast<std::size_t>(r) * kept_.size() + column(signals[s])]});
      }
      traces.push_back(std::move(trace));
    }
  }
  return traces;
}

}  // namespace kadans

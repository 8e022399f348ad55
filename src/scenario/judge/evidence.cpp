#include "evidence.h"

#include <algorithm>
#include <cmath>

namespace kadans {
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
                          .to_s = static_cast<double>(last) * period_s,
                          .values = {}};
      for (std::ptrdiff_t r = first; r < last; ++r) {
        trace.values.push_back(double{values_[static_cast<std::size_t>(r) * kept_.size() + column(signals[s])]});
      }
      traces.push_back(std::move(trace));
    }
  }
  return traces;
}

}  // namespace kadans

#include "kadans/scenario/check.h"

#include <algorithm>
#include <cmath>

namespace kadans {

// How far the value is outside the bounds; at or below 0 inside. NaN is infinitely far outside.
double Check::excess(double value) const noexcept {
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  return std::max(check_.min - value, value - check_.max);
}

void Check::update(double time_s, std::span<const double> row) noexcept {
  if (!(time_s >= check_.from_s && time_s <= check_.until_s)) return;
  const double value = row[signal_];
  double badness = excess(value);
  switch (check_.kind) {
    case CheckKind::always:
      break;
    case CheckKind::never:
    case CheckKind::eventually:
      badness = -badness;
      break;  // the value deepest inside is remembered
    case CheckKind::at_end:
      badness = std::numeric_limits<double>::max();
      break;  // the last counts
  }
  if (!seen_ || badness > worst_excess_ || check_.kind == CheckKind::at_end) {
    worst_excess_ = badness;
    value_ = value;
    at_s_ = time_s;
  }
  seen_ = true;
}

CheckResult Check::result() const {
  CheckResult result{.name = check_.name, .passed = false, .value = value_, .at_s = at_s_};
  if (!seen_) return result;  // never looked at: nothing was shown
  const bool inside = excess(value_) <= 0;
  result.passed = check_.kind == CheckKind::never ? !inside : inside;
  return result;
}

}  // namespace kadans

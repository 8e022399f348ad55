#include "margin_search.h"

#include <algorithm>
#include <cmath>

namespace kadans {

MarginSearch::MarginSearch(double nominal, double step, double end) noexcept
    : nominal_(nominal),
      step_(step),
      end_(end),
      last_(static_cast<std::int64_t>(std::ceil(std::abs(end - nominal) / step - 1e-6))) {}

std::optional<double> MarginSearch::next() const noexcept {
  const auto steps = ahead();
  return steps ? std::optional(at(*steps)) : std::nullopt;
}

void MarginSearch::tell(bool held) noexcept {
  const auto steps = ahead();
  if (!steps) return;
  if (held) {
    held_ = *steps;
  } else {
    failed_ = steps;
  }
}

std::optional<double> MarginSearch::failed() const noexcept {
  return failed_ ? std::optional(at(*failed_)) : std::nullopt;
}

std::optional<std::int64_t> MarginSearch::ahead() const noexcept {
  const std::int64_t beyond = failed_.value_or(last_ + 1);
  if (held_ + 1 >= beyond) return std::nullopt;
  if (failed_) return held_ + (beyond - held_) / 2;
  return std::min(last_, std::max<std::int64_t>(1, 2 * held_));
}

// Nine decimals, so that people and files have 1.15 and not 1.1500000000000001.
double MarginSearch::at(std::int64_t steps) const noexcept {
  if (steps == 0) return nominal_;
  if (steps >= last_) return end_;
  return std::round((nominal_ + std::copysign(static_cast<double>(steps) * step_, end_ - nominal_)) * 1e9) / 1e9;
}

}  // namespace kadans

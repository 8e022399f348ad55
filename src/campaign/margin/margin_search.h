// How far one quantity may go from its nominal value until a run fails. The search goes on a grid: first in steps that
// double, 1, 2, 4, 8 from the nominal value, until one fails; then it bisects between the last that held and the first
// that failed, until they are neighbours. It takes for granted that what lies between two values that hold, holds.
#pragma once

#include <cstdint>
#include <optional>

namespace kadans {

class MarginSearch {
 public:
  // From `nominal` in steps of step > 0 to `end`, above or below it. `end` belongs to the grid, even if the last step
  // to it is a shorter one.
  MarginSearch(double nominal, double step, double end) noexcept;

  // The value that is to be tried; nothing when the search is done.
  std::optional<double> next() const noexcept;
  // Whether the value that next() named holds.
  void tell(bool held) noexcept;

  double held() const noexcept { return at(held_); }  // the last value that holds
  std::optional<double> failed() const noexcept;      // its neighbour, which fails; nothing when `end` holds

 private:
  std::optional<std::int64_t> ahead() const noexcept;
  double at(std::int64_t steps) const noexcept;

  double nominal_, step_, end_;
  std::int64_t last_;  // steps to the end
  std::int64_t held_ = 0;
  std::optional<std::int64_t> failed_;
};

}  // namespace kadans

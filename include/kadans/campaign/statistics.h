// Estimates from a sample, with confidence intervals. All intervals have a confidence of 95 %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kadans {

struct Interval {
  double low = 0, high = 0;
};

// The score interval of a share, `hits` of `count` (Wilson, 1927). It stays within 0..1 also for small counts and when
// none or all are hits.
Interval wilson_interval(std::size_t hits, std::size_t count) noexcept;

struct SampleStatistics {
  std::size_t count = 0;                                                    // values that are numbers
  double mean = 0, median = 0, low = 0, high = 0, least = 0, greatest = 0;  // low and high: 5th and 95th percentile
  Interval mean_interval;
};

// Statistics of those values that are finite. The interval of the mean comes from a bootstrap (percentiles of 2,000
// resamples; Efron, 1979). The bootstrap's random numbers depend on the seed and the name alone.
SampleStatistics sample_statistics(const std::vector<double>& values, std::uint64_t seed, std::string_view name);

// Interpolates linearly between the two nearest values. `sorted` is ascending and not empty; share is 0..1.
double quantile(const std::vector<double>& sorted, double share) noexcept;

}  // namespace kadans

// What a sample says of what it was drawn from, and how surely. All intervals hold with 95 %.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace kadans {

struct Interval {
  double low = 0, high = 0;
};

// Of a share, `hits` of `count` (Wilson, 1927): within 0..1 also for small counts and for none or all.
Interval wilson_interval(std::size_t hits, std::size_t count) noexcept;

struct SampleStatistics {
  std::size_t count = 0;                                                    // values that are numbers
  double mean = 0, median = 0, low = 0, high = 0, least = 0, greatest = 0;  // low and high: 5th and 95th percentile
  Interval mean_interval;
};

// Of the values that are finite. The interval of the mean comes from a bootstrap (percentiles of 2,000 resamples;
// Efron, 1979), whose random numbers come from the seed and the name alone.
SampleStatistics sample_statistics(const std::vector<double>& values, std::uint64_t seed, std::string_view name);

// Linear between the two nearest values; `sorted` ascending and not empty, share 0..1.
double quantile(const std::vector<double>& sorted, double share) noexcept;

}  // namespace kadans

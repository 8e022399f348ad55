// How long ticks take: a histogram of fixed size with logarithmic buckets (32 an octave, so 2 % wide), and the
// extremes. One owner; add() neither allocates nor locks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kadans {

class TickStatistics {
 public:
  void add(std::int64_t duration_ns) noexcept;

  std::uint64_t count() const noexcept { return count_; }
  std::int64_t min_ns() const noexcept { return count_ == 0 ? 0 : min_ns_; }
  std::int64_t max_ns() const noexcept { return max_ns_; }
  double mean_ns() const noexcept { return count_ == 0 ? 0 : sum_ns_ / static_cast<double>(count_); }
  // The duration that `share` of all stay below or at (0.5: the median), within a bucket's width; 0 without any.
  double percentile_ns(double share) const noexcept;

 private:
  static constexpr std::size_t buckets_per_octave = 32;
  static constexpr std::size_t octaves = 40;

  std::array<std::uint32_t, buckets_per_octave * octaves> buckets_{};
  std::uint64_t count_ = 0;
  double sum_ns_ = 0;
  std::int64_t min_ns_ = INT64_MAX;
  std::int64_t max_ns_ = 0;
};

}  // namespace kadans

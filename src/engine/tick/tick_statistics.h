// How long ticks take: a histogram of fixed size with logarithmic buckets (32 an octave, so 2 % wide), and the
// extremes. add() belongs to one thread and neither allocates nor locks; any thread may read meanwhile: each number is
// whole, but not all are of the same moment.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kadans/exchange/one_writer.h"

namespace kadans {

class TickStatistics {
 public:
  void add(std::int64_t duration_ns) noexcept;

  std::uint64_t count() const noexcept { return count_.get(); }
  std::int64_t min_ns() const noexcept { return count() == 0 ? 0 : min_ns_.get(); }
  std::int64_t max_ns() const noexcept { return max_ns_.get(); }
  double mean_ns() const noexcept { return count() == 0 ? 0 : sum_ns_.get() / static_cast<double>(count()); }
  // The duration that a `share` of all durations do not exceed (0.5: the median), within a bucket's width; 0 when there
  // are none.
  double percentile_ns(double share) const noexcept;
  // How many durations were at most this long, within a bucket's width.
  std::uint64_t count_until(std::int64_t duration_ns) const noexcept;
  // Adds all durations of another one. Called by the thread that owns this one.
  void add_all(const TickStatistics& other) noexcept;

 private:
  static constexpr std::size_t buckets_per_octave = 32;
  static constexpr std::size_t octaves = 40;

  std::array<OneWriter<std::uint32_t>, buckets_per_octave * octaves> buckets_{};
  Count count_;
  OneWriter<double> sum_ns_;
  OneWriter<std::int64_t> min_ns_{INT64_MAX}, max_ns_;
};

}  // namespace kadans

#include "kadans/engine/tick_statistics.h"

#include <algorithm>
#include <bit>

namespace kadans {
namespace {

// Durations below 64 ns have a bucket each; from there on each octave is divided into 32.
constexpr std::uint64_t places = 32;

std::size_t bucket_of(std::uint64_t ns) noexcept {
  if (ns < 2 * places) return static_cast<std::size_t>(ns);
  const unsigned octave = static_cast<unsigned>(std::bit_width(ns)) - 6;
  return static_cast<std::size_t>(octave * places + (ns >> octave));
}

double middle_of(std::size_t bucket) noexcept {
  if (bucket < 2 * places) return static_cast<double>(bucket);
  const std::size_t octave = bucket / places - 1;
  const std::uint64_t lowest = (bucket - octave * places) << octave;
  return static_cast<double>(lowest) + 0.5 * static_cast<double>((std::uint64_t{1} << octave) - 1);
}

}  // namespace

void TickStatistics::add(std::int64_t duration_ns) noexcept {
  const std::int64_t ns = std::max<std::int64_t>(duration_ns, 0);
  const std::size_t bucket = std::min(bucket_of(static_cast<std::uint64_t>(ns)), buckets_.size() - 1);
  ++buckets_[bucket];
  ++count_;
  sum_ns_ += static_cast<double>(ns);
  min_ns_ = std::min(min_ns_, ns);
  max_ns_ = std::max(max_ns_, ns);
}

double TickStatistics::percentile_ns(double share) const noexcept {
  if (count_ == 0) return 0;
  const double wanted = share * static_cast<double>(count_);
  double seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    seen += buckets_[i];
    if (seen >= wanted && buckets_[i] > 0) {
      return std::clamp(middle_of(i), static_cast<double>(min_ns_), static_cast<double>(max_ns_));
    }
  }
  return static_cast<double>(max_ns_);
}

}  // namespace kadans

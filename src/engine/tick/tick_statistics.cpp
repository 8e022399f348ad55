#include "tick_statistics.h"

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
  buckets_[bucket].add(1);
  count_.add(1);
  sum_ns_.add(static_cast<double>(ns));
  min_ns_.set(std::min(min_ns_.get(), ns));
  max_ns_.set(std::max(max_ns_.get(), ns));
}

double TickStatistics::percentile_ns(double share) const noexcept {
  if (count() == 0) return 0;
  const double wanted = share * static_cast<double>(count());
  double seen = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    const std::uint32_t here = buckets_[i].get();
    seen += here;
    if (seen >= wanted && here > 0) {
      return std::clamp(middle_of(i), static_cast<double>(min_ns()), static_cast<double>(max_ns()));
    }
  }
  return static_cast<double>(max_ns());
}

std::uint64_t TickStatistics::count_until(std::int64_t duration_ns) const noexcept {
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < buckets_.size() && middle_of(i) <= static_cast<double>(duration_ns); ++i) {
    seen += buckets_[i].get();
  }
  return seen;
}

void TickStatistics::add_all(const TickStatistics& other) noexcept {
  for (std::size_t i = 0; i < buckets_.size(); ++i) buckets_[i].add(other.buckets_[i].get());
  count_.add(other.count());
  sum_ns_.add(other.sum_ns_.get());
  min_ns_.set(std::min(min_ns_.get(), other.min_ns_.get()));
  max_ns_.set(std::max(max_ns_.get(), other.max_ns_.get()));
}

}  // namespace kadans

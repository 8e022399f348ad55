// The durations of ticks for reports: in microseconds, rounded to nanoseconds.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include <nlohmann/json_fwd.hpp>

#include "engine/tick/tick_statistics.h"

namespace kadans {

struct TickQuantile {
  const char* name;
  double share;
};
inline constexpr TickQuantile p50{"p50", 0.5}, p90{"p90", 0.9}, p99{"p99", 0.99}, p999{"p999", 0.999},
    p9999{"p9999", 0.9999}, p99999{"p99999", 0.99999};

inline double in_us(double ns) { return std::round(ns) / 1000; }
inline double in_us(std::int64_t ns) { return in_us(static_cast<double>(ns)); }
inline double in_us(const TickStatistics& statistics, const TickQuantile& quantile) {
  return in_us(statistics.percentile_ns(quantile.share));
}

// An object with min, mean, the given quantiles, max.
nlohmann::ordered_json tick_json(const TickStatistics& statistics, std::span<const TickQuantile> quantiles);

}  // namespace kadans

#include "timing_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"

namespace kadans {
namespace {

constexpr double limit_max_us = 20'000, limit_step = 1.0905077326652577;  // 8 an octave

}  // namespace

std::string timing_json(const std::vector<TimingSource>& sources) {
  constexpr int bins = 48;
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const TimingSource& source : sources) {
    const TickStatistics& s = *source.statistics;
    if (s.count() == 0) continue;
    const double low = static_cast<double>(s.min_ns());
    const double high = std::max(low + bins, s.percentile_ns(0.9999));
    nlohmann::ordered_json counts = nlohmann::ordered_json::array();
    std::uint64_t below = 0;
    for (int i = 1; i <= bins; ++i) {
      const std::uint64_t until =
          i == bins ? s.count() : s.count_until(std::llround(low + (high - low) * static_cast<double>(i) / bins));
      counts.push_back(until > below ? until - below : 0);
      below = std::max(below, until);
    }
    nlohmann::ordered_json limits = nlohmann::ordered_json::array(), within = nlohmann::ordered_json::array();
    for (double limit_us = 1; limit_us < limit_max_us; limit_us *= limit_step) {
      limits.push_back(std::round(limit_us * 10) / 10);
      within.push_back(s.count_until(std::llround(limit_us * 1e3)));
    }
    json[source.name] = {{"unit", "us"},
                         {"low", low * 1e-3},
                         {"high", high * 1e-3},
                         {"counts", counts},
                         {"median", s.percentile_ns(0.5) * 1e-3},
                         {"p99", s.percentile_ns(0.99) * 1e-3},
                         {"max", static_cast<double>(s.max_ns()) * 1e-3},
                         {"count", s.count()},
                         {"limits", limits},
                         {"within", within}};
  }
  return json_text(json);
}

}  // namespace kadans

#include "kadans/telemetry/timing_json.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace kadans {

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
    json[source.name] = {{"unit", "us"},
                         {"low", low * 1e-3},
                         {"high", high * 1e-3},
                         {"counts", counts},
                         {"median", s.percentile_ns(0.5) * 1e-3},
                         {"p99", s.percentile_ns(0.99) * 1e-3},
                         {"max", static_cast<double>(s.max_ns()) * 1e-3},
                         {"count", s.count()}};
  }
  return json.dump();
}

}  // namespace kadans

#include "tick_report.h"

#include <nlohmann/json.hpp>

namespace kadans {

nlohmann::ordered_json tick_json(const TickStatistics& statistics, std::span<const TickQuantile> quantiles) {
  nlohmann::ordered_json json{{"min", in_us(statistics.min_ns())}, {"mean", in_us(statistics.mean_ns())}};
  for (const TickQuantile& quantile : quantiles) json[quantile.name] = in_us(statistics, quantile);
  json["max"] = in_us(statistics.max_ns());
  return json;
}

}  // namespace kadans

#include "kadans/campaign/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "kadans/signal/random.h"

namespace kadans {
namespace {

constexpr double z = 1.959963984540054;  // 97.5 % quantile of the standard normal distribution
constexpr std::size_t resamples = 2000;

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Interval bootstrap(const std::vector<double>& values, RandomStream random) {
  std::vector<double> means(resamples);
  const auto count = static_cast<double>(values.size());
  for (double& mean : means) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      sum += values[std::min(values.size() - 1, static_cast<std::size_t>(random.uniform() * count))];
    mean = sum / count;
  }
  std::ranges::sort(means);
  return {quantile(means, 0.025), quantile(means, 0.975)};
}

}  // namespace

Interval wilson_interval(std::size_t hits, std::size_t count) noexcept {
  if (count == 0) return {0, 1};
  const auto n = static_cast<double>(count);
  const double share = static_cast<double>(hits) / n;
  const double middle = share + z * z / (2 * n);
  const double half = z * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
  const double scale = 1 + z * z / n;
  return {std::max(0.0, (middle - half) / scale), std::min(1.0, (middle + half) / scale)};
}

double quantile(const std::vector<double>& sorted, double share) noexcept {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

SampleStatistics sample_statistics(const std::vector<double>& values, std::uint64_t seed, std::string_view name) {
  std::vector<double> sorted;
  std::ranges::copy_if(values, std::back_inserter(sorted), [](double value) { return std::isfinite(value); });
  if (sorted.empty()) return {};
  std::ranges::sort(sorted);
  return {.count = sorted.size(),
          .mean = mean_of(sorted),
          .median = quantile(sorted, 0.5),
          .low = quantile(sorted, 0.05),
          .high = quantile(sorted, 0.95),
          .least = sorted.front(),
          .greatest = sorted.back(),
          .mean_interval = bootstrap(sorted, RandomStream(seed, "bootstrap." + std::string(name)))};
}

}  // namespace kadans

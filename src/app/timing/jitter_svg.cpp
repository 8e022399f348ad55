// Draws the histograms: lateness to the right, shares upwards, both logarithmic, ours beside that of cyclictest.
#include <algorithm>
#include <cmath>

#include "jitter_report.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

constexpr double ns_min = 10, ns_max = 1e8, share_min = 1e-6;
constexpr int bins = 84;  // 12 a decade

PlotLine curve(const char* label, const TickStatistics& statistics) {
  const auto total = static_cast<double>(std::max<std::uint64_t>(statistics.count(), 1));
  PlotLine line{.label = label, .points = {}};
  std::uint64_t before = 0;
  for (int i = 0; i < bins; ++i) {
    const double from_ns = ns_min * std::pow(10, i / 12.0), to_ns = ns_min * std::pow(10, (i + 1) / 12.0);
    const std::uint64_t until = statistics.count_until(static_cast<std::int64_t>(to_ns));
    const double share = std::max(static_cast<double>(until - before) / total, share_min);
    line.points.push_back({from_ns, share});
    line.points.push_back({to_ns, share});
    before = until;
  }
  return line;
}

}  // namespace

std::string jitter_svg(const JitterRun& run) {
  Plot plot{.title = "lateness of wake-ups, and its share of all",
            .x = {.range = {ns_min, ns_max}, .logarithmic = true},
            .y = {.range = {share_min, 1}, .logarithmic = true},
            .lines = {curve("kadans", together(run.own).statistics.lateness)}};
  double ns = ns_min;
  for (const char* time : {"10 ns", "100 ns", "1 us", "10 us", "100 us", "1 ms", "10 ms", "100 ms"}) {
    plot.x.ticks.push_back({ns, time});
    ns *= 10;
  }
  double share = 1;
  for (const char* name : {"100 %", "10 %", "1 %", "0.1 %", "0.01 %", "1e-5", "1e-6"}) {
    plot.y.ticks.push_back({share, name});
    share /= 10;
  }
  if (!run.yardstick.empty()) plot.lines.push_back(curve("cyclictest", together(run.yardstick).lateness));
  return plot_svg(plot);
}

}  // namespace kadans

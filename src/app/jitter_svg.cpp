// Draws the histograms: lateness to the right, shares upwards, both logarithmic, ours beside that of cyclictest.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "jitter_report.h"

namespace kadans {
namespace {

constexpr double width = 720, height = 360, left = 60, bottom = 310, top = 30, right = 700;
constexpr double ns_min = 10, ns_max = 1e8;
constexpr double share_min = 1e-6;
constexpr int bins = 84;  // 12 for each decade

double x_of(double ns) { return left + (right - left) * std::log(ns / ns_min) / std::log(ns_max / ns_min); }

double y_of(double share) { return bottom - (bottom - top) * (1 - std::log10(std::max(share, share_min)) / -6); }

std::string shape(const char* pattern, double a, double b, double c, double d) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), pattern, a, b, c, d);
  return text.data();
}

std::string text_at(double x, double y, const char* anchor, const std::string& text) {
  return shape("<text x=\"%.1f\" y=\"%.1f\" ", x, y, 0, 0) + "text-anchor=\"" + anchor + "\">" + text + "</text>\n";
}

std::string axes() {
  std::string svg;
  const std::array<const char*, 8> times{"10 ns", "100 ns", "1 us", "10 us", "100 us", "1 ms", "10 ms", "100 ms"};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double x = x_of(ns_min * std::pow(10, static_cast<double>(i)));
    svg += shape("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", x, top, x, bottom);
    svg += text_at(x, bottom + 16, "middle", times[i]);
  }
  const std::array<const char*, 7> shares{"100 %", "10 %", "1 %", "0.1 %", "0.01 %", "1e-5", "1e-6"};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const double y = y_of(std::pow(10, -static_cast<double>(i)));
    svg += shape("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#ddd\"/>\n", left, y, right, y);
    svg += text_at(left - 6, y + 4, "end", shares[i]);
  }
  return svg;
}

std::string curve(const TickStatistics& statistics, const char* color) {
  const auto total = static_cast<double>(std::max<std::uint64_t>(statistics.count(), 1));
  std::string points;
  std::uint64_t before = 0;
  for (int i = 0; i < bins; ++i) {
    const double from_ns = ns_min * std::pow(10, i / 12.0), to_ns = ns_min * std::pow(10, (i + 1) / 12.0);
    const std::uint64_t until = statistics.count_until(static_cast<std::int64_t>(to_ns));
    const double y = y_of(static_cast<double>(until - before) / total);
    points += shape("%.1f,%.1f %.1f,%.1f ", x_of(from_ns), y, x_of(to_ns), y);
    before = until;
  }
  return "<polyline fill=\"none\" stroke=\"" + std::string(color) + "\" stroke-width=\"1.5\" points=\"" + points +
         "\"/>\n";
}

}  // namespace

std::string jitter_svg(const JitterRun& run) {
  std::string svg =
      shape("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" ", width, height, 0, 0) +
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  svg += axes() + curve(together(run.own).statistics.lateness, "#0a5");
  svg += text_at(right, top - 10, "end", "lateness of wake-ups at 1 kHz: kadans green, cyclictest grey");
  if (!run.yardstick.empty()) svg += curve(together(run.yardstick).lateness, "#888");
  return svg + "</svg>\n";
}

}  // namespace kadans

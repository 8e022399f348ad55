#include "kadans/campaign/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

#include "kadans/config/problems.h"
#include "kadans/scenario/html_page.h"
#include "kadans/signal/number_text.h"

namespace kadans {
namespace {

constexpr std::size_t values_max = 24, bins = 10;
constexpr int field_width = 56, field_height = 36, left = 110, top = 48, bottom = 70, legend = 120;

// The columns or rows of one quantity.
struct Axis {
  std::string name;
  std::vector<double> values;  // each its own field; empty: equal parts of low..high
  double low = 0, high = 0;

  std::size_t size() const noexcept { return values.empty() ? bins : values.size(); }
  std::size_t place(double value) const {
    if (!values.empty()) return static_cast<std::size_t>(std::ranges::lower_bound(values, value) - values.begin());
    const double share = (value - low) / (high - low);
    return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
  }
  std::string label(std::size_t at) const {
    if (!values.empty()) return printed("%.3g", values[at]);
    return printed("%.3g", low + (high - low) * (static_cast<double>(at) + 0.5) / static_cast<double>(bins));
  }
};

Axis axis_of(const MergedSweep& sweep, const std::string& name) {
  std::set<double> values;
  for (const CaseRow& row : sweep.rows) {
    if (const double value = value_of(row, name); std::isfinite(value)) values.insert(value);
  }
  if (values.empty())
    throw InputError({.file = "--heat-map", .message = unknown_name("quantity", name, sweep.quantities)});
  Axis axis{.name = name, .values = {}, .low = *values.begin(), .high = *values.rbegin()};
  if (values.size() <= values_max) axis.values.assign(values.begin(), values.end());
  return axis;
}

struct Field {
  double sum = 0;
  std::size_t count = 0;
  double mean() const noexcept { return sum / static_cast<double>(count); }
};

// Perceptually even from dark to bright (five points of the viridis map of matplotlib, CC0).
std::string color(double share) {
  constexpr double points[5][3] = {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}};
  const double at = std::clamp(share, 0.0, 1.0) * 4;
  const auto below = std::min<std::size_t>(3, static_cast<std::size_t>(at));
  int parts[3];
  for (std::size_t i = 0; i < 3; ++i)
    parts[i] = static_cast<int>(
        std::lround(points[below][i] + (at - static_cast<double>(below)) * (points[below + 1][i] - points[below][i])));
  return printed("#%02x%02x%02x", parts[0], parts[1], parts[2]);
}

class Picture {
 public:
  Picture(const MergedSweep& sweep, const HeatMapOptions& options)
      : options_(options),
        x_(axis_of(sweep, options.x)),
        y_(axis_of(sweep, options.y)),
        fields_(x_.size() * y_.size()) {
    const auto& metrics = sweep.manifest.metrics;
    if (!options.metric.empty() && std::ranges::find(metrics, options.metric) == metrics.end())
      throw InputError({.file = "--heat-map", .message = unknown_name("metric", options.metric, metrics)});
    for (const CaseRow& row : sweep.rows) add(row);
    if (!options.metric.empty()) find_range();
    title_ = sweep.manifest.sweep + ": " + (options.metric.empty() ? "share that passed" : "mean of " + options.metric);
  }

  std::string svg() const {
    const int width = left + static_cast<int>(x_.size()) * field_width + legend;
    const int height = top + static_cast<int>(y_.size()) * field_height + bottom;
    std::string text = printed(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
        "font-family=\"sans-serif\" font-size=\"11\" text-anchor=\"middle\">\n",
        width, height);
    text += printed("<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", width, height);
    text += printed("<text x=\"%d\" y=\"24\" font-size=\"14\" text-anchor=\"start\">", left) + html_text(title_) +
            "</text>\n";
    for (std::size_t row = 0; row < y_.size(); ++row) {
      for (std::size_t column = 0; column < x_.size(); ++column) text += field_svg(column, row);
    }
    return text + labels() + "</svg>\n";
  }

 private:
  void add(const CaseRow& row) {
    const double x = value_of(row, x_.name), y = value_of(row, y_.name);
    const double value =
        options_.metric.empty() ? (row.status == RunStatus::passed ? 1.0 : 0.0) : value_of(row, options_.metric);
    if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(value)) return;
    Field& field = fields_[y_.place(y) * x_.size() + x_.place(x)];
    field.sum += value;
    ++field.count;
  }
  void find_range() {
    low_ = std::numeric_limits<double>::infinity();
    high_ = -low_;
    for (const Field& field : fields_) {
      if (field.count == 0) continue;
      low_ = std::min(low_, field.mean());
      high_ = std::max(high_, field.mean());
    }
  }
  int x_of(std::size_t column) const { return left + static_cast<int>(column) * field_width; }
  int y_of(std::size_t row) const { return top + static_cast<int>(y_.size() - 1 - row) * field_height; }

  std::string field_svg(std::size_t column, std::size_t row) const {
    const Field& field = fields_[row * x_.size() + column];
    const int x = x_of(column), y = y_of(row);
    if (field.count == 0)
      return printed("<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"#eee\" stroke=\"#fff\"/>\n", x, y,
                     field_width, field_height);
    const double share = high_ > low_ ? (field.mean() - low_) / (high_ - low_) : 1;
    const char* const ink = share > 0.6 ? "#000" : "#fff";
    return printed("<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"%s\" stroke=\"#fff\"/>\n", x, y,
                   field_width, field_height, color(share).c_str()) +
           printed("<text x=\"%d\" y=\"%d\" fill=\"%s\">%.3g</text>\n", x + field_width / 2, y + 16, ink,
                   field.mean()) +
           printed("<text x=\"%d\" y=\"%d\" fill=\"%s\" font-size=\"9\">%zu</text>\n", x + field_width / 2, y + 29, ink,
                   field.count);
  }

  std::string labels() const {
    const int bottom_y = y_of(0) + field_height;
    std::string text;
    for (std::size_t i = 0; i < x_.size(); ++i)
      text +=
          printed("<text x=\"%d\" y=\"%d\">%s</text>\n", x_of(i) + field_width / 2, bottom_y + 16, x_.label(i).c_str());
    for (std::size_t i = 0; i < y_.size(); ++i)
      text += printed("<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>\n", left - 8,
                      y_of(i) + field_height / 2 + 4, y_.label(i).c_str());
    const int middle_x = left + static_cast<int>(x_.size()) * field_width / 2;
    const int middle_y = top + static_cast<int>(y_.size()) * field_height / 2;
    text += printed("<text x=\"%d\" y=\"%d\" font-size=\"12\">", middle_x, bottom_y + 40) + html_text(x_.name) +
            "</text>\n";
    text += printed("<text transform=\"translate(20 %d) rotate(-90)\" font-size=\"12\">", middle_y) +
            html_text(y_.name) + "</text>\n";
    constexpr int parts = 5;
    const int legend_x = x_of(x_.size()) + 20;
    for (int i = 0; i < parts; ++i) {
      const double share = static_cast<double>(i) / (parts - 1);
      const int y = top + (parts - 1 - i) * 22;
      text += printed("<rect x=\"%d\" y=\"%d\" width=\"18\" height=\"22\" fill=\"%s\"/>\n", legend_x, y,
                      color(share).c_str());
      text += printed("<text x=\"%d\" y=\"%d\" text-anchor=\"start\">%.3g</text>\n", legend_x + 24, y + 15,
                      low_ + share * (high_ - low_));
    }
    return text;
  }

  const HeatMapOptions& options_;
  Axis x_, y_;
  std::vector<Field> fields_;
  double low_ = 0, high_ = 1;
  std::string title_;
};

}  // namespace

std::string heat_map_svg(const MergedSweep& sweep, const HeatMapOptions& options) {
  return Picture(sweep, options).svg();
}

}  // namespace kadans

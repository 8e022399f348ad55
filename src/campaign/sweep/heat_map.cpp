#include "heat_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "config/json/problems.h"
#include "signal/number_text.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

constexpr std::size_t values_max = 24, bins = 10;
constexpr double field_width = 56, field_height = 36;

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
    Plot plot{.title = title_, .x = plot_axis(x_), .y = plot_axis(y_)};
    for (std::size_t row = 0; row < y_.size(); ++row) {
      for (std::size_t column = 0; column < x_.size(); ++column) plot.fields.push_back(plot_field(column, row));
    }
    for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0})
      plot.key.push_back({color(share), printed("%.3g", low_ + share * (high_ - low_))});
    return plot_svg(plot, {.width = field_width * static_cast<double>(x_.size()),
                           .height = field_height * static_cast<double>(y_.size()),
                           .left = 110,
                           .top = 48,
                           .right = 120,
                           .bottom = 70});
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
  static PlotAxis plot_axis(const Axis& axis) {
    PlotAxis drawn{.name = axis.name, .range = {0, static_cast<double>(axis.size())}};
    for (std::size_t i = 0; i < axis.size(); ++i) drawn.ticks.push_back({static_cast<double>(i) + 0.5, axis.label(i)});
    return drawn;
  }
  PlotField plot_field(std::size_t column, std::size_t row) const {
    const Field& field = fields_[row * x_.size() + column];
    if (field.count == 0) return {.column = column, .row = row, .color = "#eee"};
    const double share = high_ > low_ ? (field.mean() - low_) / (high_ - low_) : 1;
    return {.column = column,
            .row = row,
            .color = color(share),
            .ink = share > 0.6 ? "#000" : "#fff",
            .text = printed("%.3g", field.mean()),
            .small_text = std::to_string(field.count)};
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

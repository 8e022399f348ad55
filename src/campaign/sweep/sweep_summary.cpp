
#include "sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "config/json/problems.h"
#include "kadans/campaign/statistics.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

constexpr std::size_t worst_shown = 5, missing_shown = 20;

std::string share_text(std::size_t hits, std::size_t count) {
  const Interval interval = wilson_interval(hits, count);
  const double share = count > 0 ? static_cast<double>(hits) / static_cast<double>(count) : 0;
  return printed("%zu of %zu, %.1f %% (%.1f .. %.1f)", hits, count, 100 * share, 100 * interval.low,
                 100 * interval.high);
}

std::string scenarios_text(const MergedSweep& sweep) {
  std::map<std::string, std::pair<std::size_t, std::size_t>> scenarios;  // passed, all
  for (const CaseRow& row : sweep.rows) {
    auto& [hits, count] = scenarios[row.scenario];
    hits += row.status == RunStatus::passed ? 1 : 0;
    ++count;
  }
  std::string text;
  if (scenarios.size() < 2) return text;
  for (const auto& [scenario, of] : scenarios)
    text += "    " + scenario + ": " + share_text(of.first, of.second) + '\n';
  return text;
}

std::string metrics_text(const MergedSweep& sweep) {
  std::string text;
  for (const std::string& metric : sweep.manifest.metrics) {
    std::vector<double> values;
    for (const CaseRow& row : sweep.rows) values.push_back(value_of(row, metric));
    const SampleStatistics s = sample_statistics(values, sweep.manifest.seed, metric);
    text += "  " + metric;
    if (s.count == 0) {
      text += ": no run has it\n";
      continue;
    }
    text += printed(": mean %.4g (%.4g .. %.4g), median %.4g, 5..95 %% %.4g .. %.4g, all %.4g .. %.4g", s.mean,
                    s.mean_interval.low, s.mean_interval.high, s.median, s.low, s.high, s.least, s.greatest);
    text += (s.count < values.size() ? printed(", of %zu runs", s.count) : std::string()) + '\n';
  }
  return text;
}

std::string failures_text(const MergedSweep& sweep) {
  std::map<std::string, std::size_t> reasons;
  for (const CaseRow& row : sweep.rows) {
    if (row.status == RunStatus::passed) continue;
    ++reasons[std::string(name(row.status)) + (row.failed.empty() ? "" : ": " + row.failed)];
  }
  std::string text;
  for (const auto& [reason, count] : reasons) text += printed("  %6zu  ", count) + reason + '\n';
  return text;
}

// What failed comes first, then by the metric that says how bad, then by number.
std::vector<const CaseRow*> worst_rows(const MergedSweep& sweep) {
  std::vector<const CaseRow*> rows;
  const std::string& metric = sweep.manifest.worst;
  for (const CaseRow& row : sweep.rows) {
    if (row.status != RunStatus::passed || !metric.empty()) rows.push_back(&row);
  }
  const auto key = [&](const CaseRow* row) {
    const double value = metric.empty() ? 0 : value_of(*row, metric);
    const double badness = std::isfinite(value) ? value : -std::numeric_limits<double>::infinity();
    return std::tuple(row->status == RunStatus::passed, -badness, row->index);
  };
  std::ranges::sort(rows, {}, key);
  if (rows.size() > worst_shown) rows.resize(worst_shown);
  return rows;
}

std::string worst_text(const MergedSweep& sweep) {
  const std::vector<const CaseRow*> rows = worst_rows(sweep);
  std::string text = rows.empty() ? "" : "  worst\n";
  for (const CaseRow* row : rows) {
    text += printed("    case %zu, ", row->index) + row->scenario + ": " + name(row->status);
    if (!row->failed.empty()) text += ": " + row->failed;
    if (!sweep.manifest.worst.empty())
      text += ", " + sweep.manifest.worst + printed(" %.4g", value_of(*row, sweep.manifest.worst));
    text += "\n      again: " + row->repeat + '\n';
  }
  return text;
}

// "3, 5-9": runs of numbers.
std::string numbers_text(const std::vector<std::size_t>& numbers) {
  std::string text;
  std::size_t shown = 0;
  for (std::size_t i = 0; i < numbers.size() && shown < missing_shown; ++shown) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
    if (last > i) text += "-" + std::to_string(numbers[last]);
    i = last + 1;
    if (i < numbers.size() && shown + 1 == missing_shown) text += ", ...";
  }
  return text;
}

}  // namespace

SweepCounts counts(const MergedSweep& sweep) {
  SweepCounts counts{.cases = sweep.rows.size(), .median_s = std::numeric_limits<double>::quiet_NaN()};
  std::vector<double> times;
  for (const CaseRow& row : sweep.rows) {
    if (row.status != RunStatus::passed) continue;
    ++counts.passed;
    const double first = value_of(row, sweep.manifest.first_try);
    counts.first_try += std::isfinite(first) && first != 0 ? 1 : 0;
    if (const double time_s = value_of(row, sweep.manifest.time); std::isfinite(time_s)) times.push_back(time_s);
  }
  std::ranges::sort(times);
  if (!times.empty()) counts.median_s = quantile(times, 0.5);
  return counts;
}

bool passed(const MergedSweep& sweep) {
  const SweepCounts of = counts(sweep);
  return sweep.missing.empty() &&
         static_cast<double>(of.passed) >= sweep.manifest.passed_min * static_cast<double>(of.cases);
}

std::string sweep_summary(const MergedSweep& sweep) {
  const SweepManifest& manifest = sweep.manifest;
  const SweepCounts of = counts(sweep);
  std::string text = manifest.sweep + (manifest.doc.empty() ? "" : ": " + manifest.doc) +
                     "\n  passed: " + share_text(of.passed, of.cases) + '\n' + scenarios_text(sweep);
  if (!manifest.first_try.empty()) text += "  at the first try: " + share_text(of.first_try, of.cases) + '\n';
  if (std::isfinite(of.median_s)) text += printed("  median time: %.3g s\n", of.median_s);
  text += metrics_text(sweep) + failures_text(sweep) + worst_text(sweep);
  if (!sweep.missing.empty())
    text += printed("  missing: %zu of %zu cases: ", sweep.missing.size(), manifest.cases) +
            numbers_text(sweep.missing) + '\n';
  return text;
}

std::string sweep_json(const MergedSweep& sweep) {
  const SweepCounts of = counts(sweep);
  nlohmann::ordered_json json{{"sweep", sweep.manifest.sweep}, {"cases", of.cases}, {"passed", of.passed}};
  json["first_try"] = nullptr;
  if (!sweep.manifest.first_try.empty()) json["first_try"] = of.first_try;
  json["median_s"] = of.median_s;  // NaN becomes null
  return json_text(json);
}

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
  if (values.empty()) refuse("--heat-map", unknown_name("quantity", name, sweep.quantities));
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

// Row by row.
std::vector<Field> fields_of(const MergedSweep& sweep, const std::string& metric, const Axis& x, const Axis& y) {
  std::vector<Field> fields(x.size() * y.size());
  for (const CaseRow& row : sweep.rows) {
    const double at_x = value_of(row, x.name), at_y = value_of(row, y.name);
    const double value = metric.empty() ? (row.status == RunStatus::passed ? 1.0 : 0.0) : value_of(row, metric);
    if (!std::isfinite(at_x) || !std::isfinite(at_y) || !std::isfinite(value)) continue;
    Field& field = fields[y.place(at_y) * x.size() + x.place(at_x)];
    field.sum += value;
    ++field.count;
  }
  return fields;
}

PlotRange range_of(const std::vector<Field>& fields) {
  PlotRange range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Field& field : fields) {
    if (field.count == 0) continue;
    range.low = std::min(range.low, field.mean());
    range.high = std::max(range.high, field.mean());
  }
  return range;
}

PlotAxis plot_axis(const Axis& axis) {
  PlotAxis drawn{.name = axis.name, .range = {0, static_cast<double>(axis.size())}};
  for (std::size_t i = 0; i < axis.size(); ++i) drawn.ticks.push_back({static_cast<double>(i) + 0.5, axis.label(i)});
  return drawn;
}

PlotField plot_field(const Field& field, const PlotRange& range, std::size_t column, std::size_t row) {
  if (field.count == 0) return {.column = column, .row = row, .color = "#eee"};
  const double share = range.high > range.low ? (field.mean() - range.low) / (range.high - range.low) : 1;
  return {.column = column,
          .row = row,
          .color = color(share),
          .ink = share > 0.6 ? "#000" : "#fff",
          .text = printed("%.3g", field.mean()),
          .small_text = std::to_string(field.count)};
}

}  // namespace

std::string heat_map_svg(const MergedSweep& sweep, const HeatMapOptions& options) {
  const Axis x = axis_of(sweep, options.x), y = axis_of(sweep, options.y);
  const std::vector<std::string>& metrics = sweep.manifest.metrics;
  const bool of_metric = !options.metric.empty();
  if (of_metric && std::ranges::find(metrics, options.metric) == metrics.end())
    refuse("--heat-map", unknown_name("metric", options.metric, metrics));
  const std::vector<Field> fields = fields_of(sweep, options.metric, x, y);
  const PlotRange range = of_metric ? range_of(fields) : PlotRange{0, 1};
  Plot plot{.title = sweep.manifest.sweep + ": " + (of_metric ? "mean of " + options.metric : "share that passed"),
            .x = plot_axis(x),
            .y = plot_axis(y)};
  for (std::size_t i = 0; i < fields.size(); ++i)
    plot.fields.push_back(plot_field(fields[i], range, i % x.size(), i / x.size()));
  for (const double share : {1.0, 0.75, 0.5, 0.25, 0.0})
    plot.key.push_back({color(share), printed("%.3g", range.low + share * (range.high - range.low))});
  return plot_svg(plot, {.width = field_width * static_cast<double>(x.size()),
                         .height = field_height * static_cast<double>(y.size()),
                         .left = 110,
                         .top = 48,
                         .right = 120,
                         .bottom = 70});
}

}  // namespace kadans

#include "sweep_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "signal/number_text.h"
#include "statistics.h"

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

}  // namespace kadans

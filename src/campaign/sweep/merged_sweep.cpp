#include "merged_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace kadans {
namespace {

void refuse_mixed(const SweepResults& a, const SweepResults& b) {
  const std::string other = difference(a.manifest(), b.manifest());
  if (!other.empty())
    throw InputError(
        {.file = b.folder().string(), .message = "is of another sweep than " + a.folder().string() + ": " + other});
}

// A case that two folders hold must have come out the same.
void add(std::vector<CaseRow>& rows, std::vector<const SweepResults*>& from, CaseRow row, const SweepResults& part) {
  CaseRow& known = rows.at(row.index);
  if (from[row.index] == nullptr) {
    from[row.index] = &part;
    known = std::move(row);
    return;
  }
  if (known == row) return;
  throw InputError({.file = part.folder().string(),
                    .message = "case " + std::to_string(row.index) + " came out different from that in " +
                               from[row.index]->folder().string() + " (state " + row.state_hash + " and " +
                               known.state_hash + "); again: " + row.repeat});
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + '"';
}

void append_number(std::string& line, double value) {
  line += ',';
  if (std::isfinite(value)) line += number_text(value);
}

}  // namespace

MergedSweep merge(const std::vector<SweepResults>& parts) {
  MergedSweep merged{.manifest = parts.at(0).manifest(), .rows = {}, .missing = {}, .quantities = {}};
  std::vector<CaseRow> rows(merged.manifest.cases);
  std::vector<const SweepResults*> from(rows.size());
  for (const SweepResults& part : parts) {
    refuse_mixed(parts.front(), part);
    for (CaseRow& row : part.rows()) {
      if (row.index >= rows.size())
        throw InputError({.file = part.folder().string(),
                          .message = "case " + std::to_string(row.index) + " is none of this sweep"});
      add(rows, from, std::move(row), part);
    }
  }
  std::set<std::string> quantities;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (from[i] == nullptr) {
      merged.missing.push_back(i);
      continue;
    }
    for (const QuantityValue& quantity : rows[i].quantities) quantities.insert(quantity.name);
    merged.rows.push_back(std::move(rows[i]));
  }
  merged.quantities.assign(quantities.begin(), quantities.end());
  return merged;
}

double value_of(const CaseRow& row, const std::string& name) {
  for (const MetricValue& metric : row.metrics) {
    if (metric.name == name) return metric.value;
  }
  for (const QuantityValue& quantity : row.quantities) {
    if (quantity.name == name) return quantity.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> table_columns(const MergedSweep& sweep) {
  std::vector<std::string> columns{"case", "id", "scenario", "seed", "status", "failed", "simulated_s", "state_hash"};
  std::ranges::copy(sweep.quantities, std::back_inserter(columns));
  std::ranges::copy(sweep.manifest.metrics, std::back_inserter(columns));
  columns.emplace_back("repeat");
  return columns;
}

std::string csv_table(const MergedSweep& sweep) {
  std::string text;
  for (const std::string& column : table_columns(sweep)) text += (text.empty() ? "" : ",") + quoted(column);
  for (const CaseRow& row : sweep.rows) {
    text += "\r\n" + std::to_string(row.index) + ',' + row.id + ',' + quoted(row.scenario) + ',' +
            std::to_string(row.seed) + ',' + name(row.status) + ',' + quoted(row.failed);
    append_number(text, row.simulated_s);
    text += ',' + row.state_hash;
    for (const std::string& quantity : sweep.quantities) append_number(text, value_of(row, quantity));
    for (const std::string& metric : sweep.manifest.metrics) append_number(text, value_of(row, metric));
    text += ',' + quoted(row.repeat);
  }
  return text + "\r\n";
}

}  // namespace kadans

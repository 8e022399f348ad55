#include "margin_table.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// Name, direction, nominal, held, failed, seed; the last column is free.
std::string table_row(const std::array<std::string, 6>& cells, const std::string& last) {
  return printed("  %-28s %-4s %12s %12s %12s  %-16s  ", cells[0].c_str(), cells[1].c_str(), cells[2].c_str(),
                 cells[3].c_str(), cells[4].c_str(), cells[5].c_str()) +
         last + '\n';
}

std::string with_unit(double value, const std::string& unit) {
  return number_text(value) + (unit.empty() ? "" : " " + unit);
}

const char* direction(const Margin& margin) { return margin.end > margin.nominal ? "up" : "down"; }

// The check that failed first, and whether it did so alone; else how the run ended.
std::string reason(const CaseRow& row) {
  if (row.failed.empty()) return name(row.status);
  return row.first_failed + (row.failed == row.first_failed ? "" : ", then others");
}

Json failure_json(const CaseRow& row) {
  return {{"seed", row.seed},
          {"status", name(row.status)},
          {"check", row.first_failed},
          {"checks", row.failed},
          {"repeat", row.repeat}};
}

Json to_json(const Margin& margin) {
  Json json{{"margin", margin.name}, {"quantities", margin.patterns}, {"direction", direction(margin)},
            {"unit", margin.unit},   {"nominal", margin.nominal},     {"step", margin.step},
            {"end", margin.end},     {"held", margin.held},           {"failed", nullptr},
            {"failure", nullptr}};
  if (margin.failed) {
    json["failed"] = *margin.failed;
    json["failure"] = failure_json(margin.failure);
  }
  return json;
}

}  // namespace

std::string margin_head(const ScenarioMargins& scenario) {
  const std::string title = scenario.scenario + " (" + scenario.file + "), ";
  if (scenario.failure)
    return title + "fails as it is configured: a margin is measured from a case that holds\n  seed " +
           std::to_string(scenario.failure->seed) + ": " + reason(*scenario.failure) +
           "\n  again: " + scenario.failure->repeat + '\n';
  return title + std::to_string(scenario.seeds) + " seeds\n" +
         table_row({"quantity", "", "nominal", "holds to", "fails at", "seed"}, "what fails there");
}

std::string margin_row(const Margin& margin) {
  std::array<std::string, 6> cells{
      margin.name, direction(margin), with_unit(margin.nominal, margin.unit), with_unit(margin.held, margin.unit), "-",
      "-"};
  if (!margin.failed) return table_row(cells, "the end of the range holds");
  cells[4] = with_unit(*margin.failed, margin.unit);
  cells[5] = std::to_string(margin.failure.seed);
  return table_row(cells, reason(margin.failure));
}

std::string margin_legend(const ScenarioMargins& scenario) {
  if (scenario.failure) return "";
  std::string text =
      "  'holds to': the last value at which the runs of all seeds pass. 'fails at': the next value, at which the run "
      "of\n"
      "  this seed fails, first by this check.\n";
  const auto at_end = [](const Margin& margin) { return !margin.failed; };
  if (std::ranges::any_of(scenario.margins, at_end))
    text +=
        "  Where the end of the range holds, nothing further may be set or is tried: the margin is at least that.\n";
  for (const Margin& margin : scenario.margins) {
    if (margin.failed)
      text += "  " + margin.name + " " + direction(margin) + ", again: " + margin.failure.repeat + '\n';
  }
  return text;
}

std::string margins_json(const std::string& robot, const std::vector<ScenarioMargins>& scenarios) {
  Json json{{"margins", robot}, {"scenarios", Json::array()}};
  for (const ScenarioMargins& scenario : scenarios) {
    Json one{{"scenario", scenario.scenario},
             {"file", scenario.file},
             {"seeds", scenario.seeds},
             {"failure", nullptr},
             {"margins", Json::array()}};
    if (scenario.failure) one["failure"] = failure_json(*scenario.failure);
    for (const Margin& margin : scenario.margins) one["margins"].push_back(to_json(margin));
    json["scenarios"].push_back(std::move(one));
  }
  return json_text(json) + "\n";
}

}  // namespace kadans

// What `kadans margin` found, for people and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "campaign/sweep/sweep_results.h"

namespace kadans {

struct Margin {
  std::string name;                   // "delay", or the quantity's name or pattern
  std::vector<std::string> patterns;  // over the quantities that get the value
  std::string unit;
  double nominal = 0, step = 0, end = 0;  // of what is searched; end: furthest value
  double held = 0;                        // the last value at which all seeds hold
  std::optional<double> failed;           // the next value, at which one fails; nothing: the end holds
  CaseRow failure;                        // with `failed`: the first run that fails there
};

struct ScenarioMargins {
  std::string scenario, file;
  std::size_t seeds = 0;
  std::optional<CaseRow> failure;  // the first run that fails as configured: nothing is measured then
  std::vector<Margin> margins;
};

// Above the rows: the scenario, and the columns' names; or the sentence that it fails as it is configured.
std::string margin_head(const ScenarioMargins& scenario);
std::string margin_row(const Margin& margin);
// What the table means, in a sentence or two.
std::string margin_legend(const ScenarioMargins& scenario);
// {"margins": robot, "scenarios": [...]}, on one line.
std::string margins_json(const std::string& robot, const std::vector<ScenarioMargins>& scenarios);

}  // namespace kadans

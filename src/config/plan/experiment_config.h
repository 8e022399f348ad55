// The common part of sweeps and tunings: the scenarios that are run many times, the quantities that vary from run to
// run, and the metrics that are measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/distribution.h"
#include "config/scenario/metric_config.h"

namespace kadans {

struct ExperimentScenario {
  std::string written;  // as the plan names it
  std::string file;     // resolved
  TextPlace place;
};

// Quantities that vary, chosen by a pattern over their names.
struct ExperimentAxis {
  Variation variation;
  std::uint32_t steps = 5;  // points in a grid, when the distribution is continuous
};

struct ExperimentConfig {
  std::string file;
  std::string name;
  std::string doc;
  std::vector<ExperimentScenario> scenarios;
  std::uint64_t seed = 1;
  bool sample_randomise = false;  // samples what the scenarios randomise, too; else each run's seed draws it
  std::vector<ExperimentAxis> vary;
  std::vector<MetricConfig> metrics;
};

// Reads the fields and adds their mistakes to `problems`. Throws nothing.
void experiment_fields(Fields& f, ExperimentConfig& experiment, Problems& problems);

// Adds a problem when `name` is none of the metrics. An empty name is allowed: no metric is wanted.
void verify_metric(const PlacedName& name, const ExperimentConfig& experiment, Problems& problems);

// Reads the metrics alone from the plan of a sweep or of a tuning, for `kadans sim --metrics`. Throws InputError.
std::vector<MetricConfig> read_metrics(const std::string& file);

}  // namespace kadans

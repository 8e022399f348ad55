// What sweeps and tunings have in common: scenarios that are run many times, what varies from run to run, and what is
// measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/config/distribution.h"
#include "kadans/config/metric_config.h"

namespace kadans {

struct ExperimentScenario {
  std::string written;  // as the plan names it
  std::string file;     // resolved
  TextPlace place;
};

// Something that is varied: quantities by a pattern over their names.
struct ExperimentAxis {
  Variation variation;
  std::uint32_t steps = 5;  // of a grid, when the distribution is continuous
};

struct ExperimentConfig {
  std::string file;
  std::string name;
  std::string doc;
  std::vector<ExperimentScenario> scenarios;
  std::uint64_t seed = 1;
  bool sample_randomise = false;  // what the scenarios randomise is sampled too, else drawn by each run's seed
  std::vector<ExperimentAxis> vary;
  std::vector<MetricConfig> metrics;
};

// Reads them, and refuses what is wrong in them. Throws nothing.
void experiment_fields(Fields& f, ExperimentConfig& experiment, Problems& problems);

// Refuses a name that is none of the metrics; "" is none wanted.
void verify_metric(const PlacedName& name, const ExperimentConfig& experiment, Problems& problems);

// The plan of a sweep or of a tuning, whichever the file is: `kadans sim --metrics`. Throws InputError.
std::vector<MetricConfig> read_metrics(const std::string& file);

}  // namespace kadans

// A tuning, in one JSON file: it searches values for parameters of control objects that make a metric of the scenarios
// as small as possible over many randomised runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiment_config.h"

namespace kadans {

// One number that is searched; all parameters that the pattern chooses get it.
struct TunedParameter {
  PlacedName pattern;           // "control.posture.*_knee.kp_Nm_per_rad"
  Distribution range;           // uniform or log_uniform between the least and the greatest allowed value
  std::optional<double> start;  // without it, the search starts at the value in the robot's configuration
};

struct TunePlan : ExperimentConfig {
  std::vector<TunedParameter> tune;
  std::uint32_t runs = 8;         // runs of each candidate; all candidates have the same ones
  std::uint32_t check_runs = 40;  // runs before and after the tuning, with other seeds
  std::uint32_t population = 8;   // candidates of a generation
  std::uint32_t generations = 20;
  double step = 0.25;       // first spread of the candidates, as a share of the ranges
  PlacedName score;         // metric
  bool greatest = false;    // the greatest value is searched instead of the least
  double failed_score = 0;  // score of a run that did not pass or has no value
};

// Throws InputError with all mistakes. The scenarios' files exist, but they are not read yet.
TunePlan read_tune_plan(const std::filesystem::path& file);
TunePlan read_tune_plan_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_tune_plan();

}  // namespace kadans
